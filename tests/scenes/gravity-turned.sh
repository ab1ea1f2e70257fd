#!/bin/bash
# A scene turned with its gravity gives the turned answers: head, onset, forces, flux, height of the bed; and so do deposits that
# settle and the refinement along the bed's faces.
. "$SCENES/functions"
turn() { # DIRECTION: of gravity; boundary names down, up, sides
  case $1 in
    down) echo 'bottom top left,right 0,-9.81 0,0 0.003,0.006' ;;
    right) echo 'right left bottom,top 9.81,0 -0.006,0 0,0.003' ;;
    left) echo 'left right bottom,top -9.81,0 0,0 0.006,0.003' ;;
    up) echo 'top bottom left,right 0,9.81 0,-0.006 0.003,0' ;;
  esac
}
for direction in down right left up; do
  read -r floor lid sides gravity lower upper <<<"$(turn $direction)"
  cat >$direction.prm <<END
set Gravity = $gravity
subsection Time
  set Time step = 1e-3
  set End time  = 0.02
end
subsection Domain
  set Lower left corner  = $lower
  set Upper right corner = $upper
end
subsection Mesh refinement
  set Criteria = bed faces
end
subsection Boundary conditions
  set Slip walls = $sides
  set Pressure   = $lid: 0; $floor: rho*g*H*(1 + 8*t)
end
subsection Grains
  set Fluid packing fraction = 0.6
  subsection Deposit: settled bed
    set Number of grains  = 100
    set Smallest diameter = 0.2e-3
    set Cache folder      =
  end
end
subsection Contacts
  set Residual tolerance = 1e-6
end
subsection Output
  set Output folder        = $direction
  set Interval of pictures = 0
  subsection Observers: support
    set Floor = $floor
  end
end
END
  must_run 1 $direction.prm
done
python3 - <<'END' || fail 'the turned scenes differ'
import csv, json, sys
rows = {d: list(csv.DictReader(open(d + "/statistics.csv")))[-1] for d in ("down", "right", "left", "up")}
summary = {d: json.load(open(d + "/summary.json")) for d in rows}
flux = {"down": "top", "right": "left", "left": "right", "up": "bottom"}
good = True
for d in rows:
    for name in ("differential_head_m", "bed_height_m", "floor_force_over_weight", "fluid_force_over_weight",
                 "largest_fluid_velocity_m_per_s", "flux"):
        column = lambda of: float(rows[of]["flux_%s_m2_per_s" % flux[of] if name == "flux" else name])
        # what friction gives the side walls depends on the order of contacts
        tolerance = 1e-2 if name == "floor_force_over_weight" else 1e-4
        if not abs(column(d) - column("down")) <= tolerance * abs(column("down")):
            print(d, name, column(d), "instead of", column("down"))
            good = False
    exact = [summary[x]["onset by force balance"]["exact_head_m"] for x in (d, "down")]
    if not abs(exact[0] - exact[1]) < 1e-9:
        print(d, "exact head", exact)
        good = False
sys.exit(not (good and float(rows["down"]["differential_head_m"]) > 1e-4))
END
