#!/usr/bin/env bash
# Builds unit tests with a sanitizer and runs them. Installs what is missing, as test.sh does.
#   tests/sanitize.sh [asan|tsan] [MODULE ...]
# asan: memory and undefined behaviour (default); tsan: threads. Without modules: the unit tests of all of them.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-asan}
shift || true
cmake/install-dependencies.sh
cmake --preset "$preset"
if [ $# -eq 0 ]; then
  cmake --build --preset "$preset" -j "$(nproc)"
  ctest --preset "$preset" -j "$(nproc)"
else
  cmake --build --preset "$preset" -j "$(nproc)" --target "${@/#/test_}"
  ctest --preset "$preset" -j "$(nproc)" -R "^($(IFS='|'; echo "$*"))\."
fi
