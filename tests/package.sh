#!/usr/bin/env bash
# tests/package.sh [BUILD_FOLDER]: makes the Debian package and checks it, in less than a minute where all is built.
# Without a folder it configures and builds build/package. The package is unpacked into a folder with a space in its
# name, and used there as an installation: the sample, a plug-in and the examples against its headers, manual pages and
# completion. TAUT_PACKAGE_ROOT=FOLDER keeps what was unpacked. tests/package-fresh.sh installs it on a fresh Debian 12.
set -euo pipefail
cd "$(dirname "$0")/.."
source_folder=$PWD
if [ $# -gt 0 ]; then
  build=$(realpath "$1")
else
  cmake --preset package
  build=$PWD/build/package
fi
cmake --build "$build" # with Ninja cpack takes what is there, however old it is
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

fail() { echo "tests/package.sh: $*" >&2; exit 1; }
step() { echo "-- $*"; }

step "Making the package"
rm -f "$build"/taut_*.deb
(cd "$build" && cpack) > "$scratch/cpack.log" 2>&1 || { cat "$scratch/cpack.log"; fail "cpack failed"; }
packages=("$build"/taut_*.deb)
if [ ${#packages[@]} -ne 1 ] || [ ! -f "${packages[0]}" ]; then fail "cpack left not one package: ${packages[*]}"; fi
package=${packages[0]}

step "Checking its fields"
field() { dpkg-deb --field "$package" "$1"; }
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:[A-Z]*=//p' "$build/CMakeCache.txt")
[ "$(field Package)" = taut ] || fail "its name is $(field Package)"
[ "$(field Version)" = "$version" ] || fail "its version is $(field Version), not $version"
[ "$(field Architecture)" = "$(dpkg --print-architecture)" ] || fail "its architecture is $(field Architecture)"
for needed in libc6 libmrpt-obs libmrpt-maps libosmesa6 libyaml-cpp liboctomap libnlopt libpcap libsqlite3; do
  [[ $(field Depends) == *"$needed"* ]] || fail "Depends lacks $needed: $(field Depends)"
done
[[ $(field Depends) != *-dev* && $(field Depends) != *libtaut* ]] || fail "Depends has too much: $(field Depends)"
# Each package of cmake/tautConfig.cmake is there to be had.
for needed in libeigen3-dev libmrpt-core-dev libmrpt-rtti-dev robin-map-dev liboctomap-dev; do
  [[ $(field Recommends) == *"$needed"* ]] || fail "Recommends lacks $needed: $(field Recommends)"
done

step "Unpacking it"
root=${TAUT_PACKAGE_ROOT:-"$scratch/some where"}
mkdir -p "$root"
dpkg-deb --extract "$package" "$root"
dpkg-deb --control "$package" "$scratch/control"
grep -q ldconfig "$scratch/control/postinst" || fail "it does not tell ldconfig of its libraries"
usr=$root/usr
libraries=$(dirname "$(find "$usr/lib" -name 'libtaut_core.so')")
documentation=$usr/share/doc/taut

step "Checking its content"
programs=$(cd "$build/share/man/man1" && ls -- *.1)
programs=${programs//.1/}
[[ $programs == *taut-slam* ]] || fail "$build knows no programs"
for program in $programs; do
  for file in "bin/$program" "share/man/man1/$program.1.gz" "share/bash-completion/completions/$program"; do
    [ -f "$usr/$file" ] || fail "/usr/$file is absent"
  done
done
for library in "$build"/lib/libtaut_*.so; do
  [ -e "$libraries/$(basename "$library")" ] || fail "$(basename "$library") is absent"
done
for headers in modules/*/include; do
  (cd "$headers" && find . -name '*.h') | while read -r header; do
    cmp -s "$headers/$header" "$usr/include/$header" || fail "the header $header is absent or another"
  done
done
for file in share/taut/config/default.yaml share/taut/rawlogs/hall_fast.rawlog share/doc/taut/copyright \
  share/doc/taut/changelog.gz share/doc/taut/docs/quick-start.md share/doc/taut/examples/plugin/CMakeLists.txt; do
  [ -f "$usr/$file" ] || fail "/usr/$file is absent"
done
[ -f "$libraries/cmake/taut/tautConfig.cmake" ] || fail "tautConfig.cmake is absent"
# Nothing else: no tests, no library of somebody else, no icons.
strangers=$(cd "$root" && find . -type f ! -path './usr/bin/taut-*' ! -path './usr/lib/*/libtaut_*' \
  ! -path './usr/lib/*/cmake/taut/*' ! -path './usr/include/taut/*' ! -path './usr/share/taut/*' \
  ! -path './usr/share/doc/taut/*' ! -path './usr/share/man/man1/taut-*' \
  ! -path './usr/share/bash-completion/completions/taut-*')
[ -z "$strangers" ] || fail "files that do not belong there: $strangers"
listing=$(dpkg-deb --contents "$package")
awk '$2 != "root/root" || $1 ~ /^.....w|^........w/ && $1 !~ /^l/ { print; bad = 1 } END { exit bad }' <<< "$listing" \
  || fail "files of somebody else, or that others may write"
(cd "$root" && md5sum --quiet --check "$scratch/control/md5sums") || fail "the sums are wrong"
for file in "$usr"/bin/* "$libraries"/*.so; do
  if readelf -d "$file" | grep -E 'R(UN)?PATH' | grep -qvF "[\$ORIGIN"; then fail "$file looks for libraries elsewhere"; fi
  if readelf -d "$file" | grep -E 'R(UN)?PATH' | grep -qF "$build"; then fail "$file names the build folder"; fi
done
if grep -rlF -e "$build" -e "$source_folder" "$libraries/cmake"; then fail "the CMake package names folders of this machine"; fi

step "Running the programs"
commit=$(sed -n 's/.*kCommit = "\(.*\)";/\1/p' "$build/apps/Commit.cpp")
unset LD_LIBRARY_PATH
cd /
for program in $programs; do
  told=$("$usr/bin/$program" --version)
  [ "$told" = "$program $version (commit $commit)" ] || fail "'$program --version' says '$told'"
  LC_ALL=C ldd "$usr/bin/$program" | awk -v root="$root" '
    /not found/ || /libtaut/ && index($0, root) == 0 { print; bad = 1 } END { exit bad }' \
    || fail "$program does not find its libraries"
done
# The configuration of the installation, not that of the sources: a change to it is seen.
echo 'estimation: {max_iterations: 7}' >> "$usr/share/taut/config/default.yaml"
[[ $("$usr/bin/taut-slam" --show-config) == *"max_iterations: 7 "* ]] || fail "taut-slam does not read the installed configuration"
dpkg-deb --fsys-tarfile "$package" | tar -C "$root" -x ./usr/share/taut/config/default.yaml
sample=$usr/share/taut/rawlogs/hall_fast
"$usr/bin/taut-slam" -q -i "$sample.rawlog" -o "$scratch/out" -s initialization.rest_duration=3 --truth "$sample.gt.tum"
for file in trajectory.tum map.ply map.bt snapshot_top.png report.html metrics.json; do
  [ -s "$scratch/out/$file" ] || fail "the run of the sample left no $file"
done
rmse=$("$usr/bin/taut-evaluate" --truth "$sample.gt.tum" --estimate "$scratch/out/trajectory.tum" |
  awk '/^ATE position/ { print $4 }')
awk -v rmse="$rmse" 'BEGIN { exit !(rmse > 0 && rmse < 0.0012) }' || fail "the sample is off by '$rmse' m"

step "Building the plug-in and the examples"
build_example() {
  cmake -S "$1" -B "$2" -D CMAKE_PREFIX_PATH="$usr" -D CMAKE_BUILD_TYPE=Release
  grep -F "taut_DIR:PATH=$usr/" "$2/CMakeCache.txt"
  cmake --build "$2" --parallel "$(nproc)"
}
for example in examples/plugin examples; do
  (build_example "$documentation/$example" "$scratch/build/$example") > "$scratch/build.log" 2>&1 \
    || { cat "$scratch/build.log"; fail "$example is not built"; }
done
"$usr/bin/taut-slam" -q -i "$sample.rawlog" -o "$scratch/plugin" --no-pictures --no-report --only-first-n 60 \
  -s initialization.rest_duration=3 -p "$scratch/build/examples/plugin/libevery_nth.so" -s features.type=example::EveryNth
grep -q "type: 'example::EveryNth'" "$scratch/plugin/config.yaml" || fail "the plug-in was not used"
"$scratch/build/examples/example_read_results" "$scratch/out" > /dev/null || fail "an example does not run"

step "Reading the manual pages, completing"
for program in $programs; do
  told=$(LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -l "$usr/share/man/man1/$program.1.gz" 2>&1 > "$scratch/page") \
    || fail "no page of $program"
  [ -z "$told" ] || fail "the page of $program: $told"
  grep -q "$program" "$scratch/page" || fail "an empty page of $program"
  # shellcheck disable=SC1090
  source "$usr/share/bash-completion/completions/$program"
  COMP_WORDS=("$usr/bin/$program" --vers) COMP_CWORD=1 COMPREPLY=()
  "_${program//-/_}" "$usr/bin/$program"
  [ "${COMPREPLY[*]}" = --version ] || fail "$program is not completed"
done
echo "$package is good: $(du -k "$package" | cut -f1) kB, off by $rmse m in the sample"
