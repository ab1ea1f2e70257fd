#!/bin/bash
# Parameters that were renamed are read under their old names, in a file and by --set, and written under the new ones.
. "$SCENES/functions"
scene_from bed <<'END'
subsection Coupling
  subsection Time scheme: iterated
    set Repetitions = 3
  end
end
END
must_run 1 bed.prm --set 'Time/End time=0.001' --set 'Contacts/Push-out speed=0.2' --set 'Contacts/Cold start=false' --set 'Coupling/Filter shape=smooth' --set 'Coupling/Overlap rule=centre' --set 'Contacts/Patience=40' --set 'Contacts/Loose factor=2' --set 'Coupling/Time scheme: semi-implicit per grain/Pairs of sweeps=2'
for line in 'Coupling iterations = 3' 'Largest depenetration speed = 0.2' 'Stagnation after sweeps = 40' 'Stagnation tolerance factor = 2' 'Pairs of sub-iterations = 2' 'Hydrostatic initial guess = false'; do
  grep -qE "set ${line%% =*} +=${line##*=}$" output/parameters.prm || fail "parameters.prm lacks '$line'"
done
! grep -qE 'Repetitions|Push-out|Patience|Loose factor|Pairs of sweeps|Cold start' output/parameters.prm || fail "an old name is written"
# what the run used is read again
cp output/parameters.prm used.prm
must_run 1 used.prm --set "Output/Output folder=again" --set 'Time/End time=0.001'
must_agree output/statistics.csv again/statistics.csv --tolerance 0
# values with new names
must_run 1 used.prm --set "Output/Output folder=new" --set 'Time/End time=0.001' --set 'Coupling/Filter shape=parabolic' --set 'Coupling/Overlap rule=particle-centre'
must_agree output/statistics.csv new/statistics.csv --tolerance 0
must_run 1 used.prm --set "Output/Output folder=other" --set 'Time/End time=0.001' --set 'Coupling/Filter shape=top-hat' --set 'Coupling/Overlap rule=moments'
! cmp -s output/statistics.csv other/statistics.csv || fail "filter and rule do not matter here, so that the test shows nothing"
