#!/bin/bash
# A disk that fills up at any write ends the run with one message and exit code 1, and nothing is listed that is not whole. Needs root, for a
# small tmpfs; others run it with a limit of the size of files.
. "$SCENES/functions"
scene_from tiny <<END
subsection Mesh refinement
  set Criteria           = uniform, bed faces
  set Coarsest cell size = 8
  set Interval           = 1
end
subsection Time
  set End time = 0.03
end
END
mount=$PWD/small
mkdir -p small

listed_is_whole() { # FOLDER
  for list in "$1"/*.pvd; do
    [ -f "$list" ] || continue
    for picture in $(sed -n 's/.*file="\([^"]*\)".*/\1/p' "$list"); do
      tail -c 20 "$1/$picture" | grep -q "</VTKFile>" || fail "$picture is cut off, and listed"
    done
  done
  ! ls "$1"/*.vtu.tmp >/dev/null 2>&1 || fail "it left half of a picture"
}

ends_clearly() { # ARGUMENTS...
  alluvium 1 tiny.prm "$@"
  code=$?
  [ $code -ne 0 ] || return 0 # it has fitted
  [ $code -eq 1 ] || fail "exit code $code: $*"
  [ "$(grep -c '^alluvium: error: ' error-output)" -eq 1 ] || fail "expected one line 'alluvium: error: ...'"
  grep -qE "^alluvium: error: .*(cannot|hardly any room)" error-output || fail "the message does not say what is wrong"
  ! grep -qiE 'stack|abort|mca_' screen-output error-output || fail "a user does not want a stack trace"
}

pictures=(--set 'Output/Interval of pictures=1e-3' --set 'Output/Interval of checkpoints=2e-3')
if unshare -m true 2>/dev/null && mount -t tmpfs -o size=4k tmpfs small 2>/dev/null; then
  umount small
  trap 'umount -l "$mount" 2>/dev/null' EXIT
  for size in 4 16 40 80 160 320 1200; do
    for format in vtu hdf5; do
      mount -t tmpfs -o size=${size}k tmpfs small || fail "no tmpfs"
      ends_clearly "${pictures[@]}" --set "Output/Output folder=$mount/out" --set "Output/Format=$format"
      listed_is_whole small/out
      umount small
    done
  done
  for size in 4 40; do # on a rank that does not write, too
    mount -t tmpfs -o size=${size}k tmpfs small || fail "no tmpfs"
    alluvium 2 tiny.prm "${pictures[@]}" --set "Output/Output folder=$mount/out" --set "Output/Format=vtu" &&
      fail "two ranks fit on a disk of $size kB"
    grep -qE "^alluvium: error: .*(cannot|hardly any room)" error-output || fail "the message does not say what is wrong"
    listed_is_whole small/out
    umount small
  done
else
  (
    ulimit -f 8
    ends_clearly "${pictures[@]}" --set "Output/Output folder=small/out"
  ) || exit 1
  listed_is_whole small/out
fi
exit 0
