#!/usr/bin/env bash
# Installs the Debian 12 packages that taut builds with; does nothing where they are there already.
# With --grabber also MRPT's sensor drivers and rawlog-grabber, which pull in Qt and wxWidgets.
# With --browser also chromium, in which the tests look at report.html (124 MB to fetch, 414 MB installed).
# dpkg-dev and file are for cpack, man-db is for the tests of the manual pages.
# With --fuzz also clang 14, with which tests/fuzz is built (68 MB to fetch, 355 MB installed).
set -euo pipefail
packages=(
  g++ cmake ninja-build pkg-config
  libeigen3-dev libmrpt-maps-dev libmrpt-opengl-dev libmrpt-tclap-dev
  libyaml-cpp-dev zlib1g-dev libnlopt-cxx-dev libnlopt-dev liboctomap-dev libosmesa6-dev libnanoflann-dev robin-map-dev
  libbz2-dev liblz4-dev liblzf-dev libzstd-dev libsqlite3-dev
  libembree-dev libpcap-dev
  libgtest-dev libgmock-dev libbenchmark-dev nlohmann-json3-dev libssl-dev gnuplot-nox doxygen
  libjs-three
  dpkg-dev file man-db
)
for option in "$@"; do
  case "$option" in
    --grabber) packages+=(libmrpt-hwdrivers-dev mrpt-apps) ;;
    --browser) packages+=(chromium) ;;
    --fuzz) packages+=(clang-14 libclang-rt-14-dev llvm-14) ;;
    *) echo "$0: unknown option '$option'" >&2; exit 2 ;;
  esac
done
missing=()
for p in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$p" 2>/dev/null | grep -q 'install ok installed' || missing+=("$p")
done
[ ${#missing[@]} -eq 0 ] && exit 0
echo "Installing: ${missing[*]}"
sudo=()
[ "$(id -u)" -eq 0 ] || sudo=(sudo)
"${sudo[@]}" apt-get update -qq
"${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
