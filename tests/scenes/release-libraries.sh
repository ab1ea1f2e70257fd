#!/bin/bash
# A Release build uses deal.II's Release library, and only that: the debug library is 25 times as slow.
. "$SCENES/functions"
[ "$BUILD_TYPE" != Debug ] || exit 0
ldd "$ALLUVIUM" >libraries || fail "ldd failed"
grep -q 'libdeal[._]ii' libraries || fail "deal.II is not linked at all?"
! grep 'libdeal[._]ii\.g\.so' libraries || fail "deal.II's debug library is linked"
! grep 'not found' libraries || fail "a library is missing"
