#!/bin/bash
# A dry scene has no mesh and no matrices, however fine the mesh would be: peak memory shows it.
. "$SCENES/functions"

# peak CELLS_PER_DIAMETER ARGUMENTS...: peak memory in MB.
peak() {
  python3 - "$ALLUVIUM" bed.prm --set "Mesh refinement/Criteria: uniform/Cell size=$1" --set 'Output/Overwrite output folder=true' "${@:2}" <<'END'
import resource, subprocess, sys
with open("screen-output", "w") as out, open("error-output", "w") as err:
    if subprocess.run(sys.argv[1:], stdout=out, stderr=err, stdin=subprocess.DEVNULL).returncode:
        sys.exit(1)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024)
END
}

scene_from bed <<'END'
subsection Mesh refinement
  set Criteria = uniform
  set Interval = 0
end
subsection Time
  set End time = 0.001
end
END
dry=('--set' 'Fluid/Model=none' '--set' 'Output/Observers=motion')
coarse=$(peak 2 "${dry[@]}") && fine=$(peak 0.15 "${dry[@]}") && wet=$(peak 0.15) || fail "a run failed"
echo "peak memory: dry $coarse MB, dry with fine cells asked for $fine MB, with fluid $wet MB"
[ "$fine" -lt $((coarse + 5)) ] || fail "a dry scene pays for a mesh"
[ "$wet" -gt $((fine + 40)) ] || fail "expected the fluid to take memory; is the comparison still one?"
