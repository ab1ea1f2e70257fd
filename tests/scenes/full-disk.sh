#!/bin/bash
# A disk that fills up at any write ends the run with one message and exit code 1, and nothing is listed that is not whole. Needs root, for a
# small tmpfs; others run it with a limit of the size of files.
# SLOW
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
  # one that fills up after the trial for p4est's file, which would abort: the checkpoint before is the one that is kept
  cat >fill.c <<'END'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
int remove(const char *path)
{
  static int n_trials = 0;
  const int  result = ((int (*)(const char *))dlsym(RTLD_NEXT, "remove"))(path);
  if (strstr(path, "checkpoint.new/fluid_mesh.tmp") && ++n_trials == 3)
    {
      static char block[4096] = {1};
      const int   file = open(getenv("FILLER"), O_CREAT | O_WRONLY, 0600);
      while (write(file, block, sizeof block) > 0)
        ;
      close(file);
    }
  return result;
}
END
  if cc -shared -fPIC -o fill.so fill.c -ldl 2>/dev/null; then
    for ranks in 1 2; do
      mount -t tmpfs -o size=3000k tmpfs small || fail "no tmpfs"
      (
        export LD_PRELOAD=$PWD/fill.so FILLER=$mount/filler
        alluvium $ranks tiny.prm "${pictures[@]:2}" --set "Output/Output folder=$mount/out"
      )
      code=$?
      [ $code -eq 1 ] || fail "exit code $code of a disk that fills up under p4est on $ranks rank(s)"
      [ -f small/filler ] || fail "the disk has not been filled"
      [ "$(grep -c "^alluvium: error: cannot write '$mount/out/checkpoint.new/fluid_mesh" error-output)" -eq 1 ] ||
        fail "expected one line 'alluvium: error: cannot write ...fluid_mesh...'"
      rm small/filler
      must_run $ranks tiny.prm --set "Output/Output folder=$mount/out" --set Output/Restart=true
      grep -q "Continues from t = 0.004 s" screen-output error-output || fail "the last good checkpoint is lost"
      umount small
    done
  fi
else
  (
    ulimit -f 8
    export OMPI_MCA_btl=self # MPI has files of its own for shared memory, and complains
    ends_clearly "${pictures[@]}" --set "Output/Output folder=small/out"
  ) || exit 1
  listed_is_whole small/out
fi
exit 0
