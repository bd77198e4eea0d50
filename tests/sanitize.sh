#!/usr/bin/env bash
# Builds the unit tests with a sanitizer and runs them. Installs what is missing, as test.sh does.
#   tests/sanitize.sh [asan|tsan]     memory and undefined behaviour (default), or threads
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-asan}
cmake/install-dependencies.sh
cmake --preset "$preset"
cmake --build --preset "$preset" -j "$(nproc)"
ctest --preset "$preset" -j "$(nproc)"
