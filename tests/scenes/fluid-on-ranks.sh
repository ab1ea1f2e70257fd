#!/bin/bash
# A fluid through a bed, and grains that settle, give the same statistics on one, two and four ranks, to 1e-8 of each column's largest
# value, where the linear solver's tolerance is tight. (Beds that are being lifted do not: what contacts leave open, their tolerance, is
# filled by round-off.)
# SLOW
. "$SCENES/functions"

scene_from bed </dev/null
sed "s|^include .*|include $SCENES/data/bed.prm|" "$SCENES/suspension.prm" >suspension.prm
common=(--set 'Output/Digits=15' --set 'Time/End time=0.008' --set 'Fluid/Linear solver/Tolerance=1e-14'
        --set 'Output/Observers=head, motion, support, bed') # flux has an imbalance, all round-off

cp suspension.prm spinning.prm
# one grain, so that some ranks have none
(cat suspension.prm && echo $'subsection Grains\n set Deposit = file\n subsection Deposit: file\n  set File = lone.csv\n end\nend') >lone.prm
printf 'x,y,radius\n5e-4,5e-4,1e-4\n' >lone.csv
(cat bed.prm && echo $'subsection Mesh refinement\n set Criteria = uniform\nend') >uniform.prm # never refined: dealt out otherwise

for scene in bed uniform suspension spinning lone; do
  [ $scene = spinning ] && common+=(--set 'Coupling/Rotation=true')
  for ranks in 1 2 4; do
    must_run "$ranks" "$scene.prm" "${common[@]}" --set "Output/Output folder=$scene-$ranks"
  done
  for ranks in 2 4; do
    must_agree "$scene-1/statistics.csv" "$scene-$ranks/statistics.csv" --tolerance 1e-8
  done
  [ "$(wc -l <$scene-1/statistics.csv)" -eq 10 ] || fail "expected a row for every step"
done
# the torque is felt: the suspension that spins is another one
cmp -s suspension-1/statistics.csv spinning-1/statistics.csv && fail "Rotation changes nothing"
exit 0
