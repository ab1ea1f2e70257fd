# --check leaves no file anywhere, also where the deposit has a cache; and a run does not need to be able to write that.
. "$SCENES/functions"

mkdir scene
cat >scene/bed.prm <<END
subsection Time
  set End time  = 1e-3
  set Time step = 1e-3
end
subsection Domain
  set Lower left corner  = 0, 0
  set Upper right corner = 0.003, 0.006
end
subsection Fluid
  set Model = none
end
subsection Boundary conditions
  set No-slip walls = left, right, bottom
  set Pressure      = top: 0
end
subsection Grains
  subsection Deposit: settled bed
    set Number of grains = 60
  end
end
subsection Output
  set Interval of pictures   = 0
  set Interval of statistics = 0
end
END
cp -r scene before
must_run 1 --check scene/bed.prm
diff -r before scene || fail "--check wrote beside the scene"
[ ! -e output ] || fail "--check made an output folder"

# root may write everywhere, but not make a folder where there is a file
touch scene/deposits
must_run 1 scene/bed.prm
grep -q "warning: The settled bed is not kept" error-output || fail "it does not say that the bed is not kept"
[ "$(tail -n 1 output/statistics.csv | cut -d, -f1)" = 0.001 ] || fail "it has not run"
cp output/statistics.csv without-cache.csv

rm -r scene/deposits output
must_run 1 scene/bed.prm
ls scene/deposits/*.csv >/dev/null || fail "the bed is not kept"
must_agree without-cache.csv output/statistics.csv --tolerance 0
rm -r output
must_run 1 scene/bed.prm
must_agree without-cache.csv output/statistics.csv --tolerance 0
