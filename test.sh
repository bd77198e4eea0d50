#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests. Works on a fresh Debian 12.
set -euo pipefail
cd "$(dirname "$0")"
cmake/install-dependencies.sh
cmake --preset release
cmake --build --preset release -j "$(nproc)"
ctest --preset release -j "$(nproc)"
