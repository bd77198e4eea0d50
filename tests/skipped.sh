#!/usr/bin/env bash
# Tells how many tests the last run of ctest skipped, and why: one line a reason, none without skips.
#   tests/skipped.sh BUILD_FOLDER
set -euo pipefail
awk '
  /: Skipped$/ && getline > 0 { sub(/\): .*/, ")"); count[$0]++ }
  END { for (reason in count) print count[reason] " tests skipped: " reason }
' "$1/Testing/Temporary/LastTest.log" | sort -rn
