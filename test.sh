#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests. Works on a fresh Debian 12.
# With TAUT_REQUIRE_DATA=1 a test fails, instead of being skipped, where its recording is absent.
set -euo pipefail
cd "$(dirname "$0")"
cmake/install-dependencies.sh
cmake --preset release
cmake --build --preset release -j "$(nproc)"
result=0
ctest --preset release -j "$(nproc)" || result=$?
tests/skipped.sh build/release
exit "$result"
