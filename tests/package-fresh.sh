#!/usr/bin/env bash
# tests/package-fresh.sh PACKAGE.deb [ROOT]: installs the package on a fresh Debian 12, as apt does it for a user; runs the
# sample, builds the plug-in with Debian's compiler, looks for pages and completion, and removes it all. The fresh system
# is made by debootstrap in a folder of its own, or was made in ROOT before. Needs root, debootstrap and the network: some
# 700 MB, five minutes.
set -euo pipefail
package=$(realpath "$1")
mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}

# Mounts of a namespace of its own are gone with this script.
if [ "${TAUT_UNSHARED:-}" != 1 ]; then
  export TAUT_UNSHARED=1
  exec unshare --mount --propagation private "$0" "$package" "${@:2}"
fi
if [ $# -gt 1 ]; then
  root=$2
else
  root=$(mktemp -d)
  trap 'umount "$root/proc" || true; rm -rf --one-file-system "$root"' EXIT
  debootstrap --variant=minbase --include=ca-certificates bookworm "$root" "$mirror" > "$root/log" 2>&1 \
    || { tail "$root/log"; exit 1; }
fi
mount -t proc proc "$root/proc"
cp "$package" "$root/tmp/taut.deb"
cat > "$root/tmp/try.sh" << 'END'
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive
fail() { echo "tests/package-fresh.sh: $*" >&2; exit 1; }
cd /tmp
find / -xdev -name '*taut*' ! -path '/tmp/*' ! -path '/proc/*' > before
[ ! -s before ] || fail "the system is not fresh"

echo "-- Installing"
apt-get update -qq
apt-get install -y -qq ./taut.deb > apt.log 2>&1 || { tail apt.log; fail "apt does not install it"; }

echo "-- Running the sample"
sample=/usr/share/taut/rawlogs/hall_fast
taut-slam --version
taut-slam -i $sample.rawlog -o out -s initialization.rest_duration=3 --truth $sample.gt.tum
taut-evaluate --truth $sample.gt.tum --estimate out/trajectory.tum | tee scores
awk '/^ATE position/ { exit !($4 > 0 && $4 < 0.0012) }' scores || fail "the sample is off"
for picture in top oblique follow; do [ -s out/snapshot_$picture.png ] || fail "no picture"; done

echo "-- Building the plug-in"
apt-get install -y -qq --no-install-recommends g++ cmake make man-db bash-completion >> apt.log 2>&1 \
  || { tail apt.log; fail "no compiler"; }
for example in plugin .; do
  cmake -S /usr/share/doc/taut/examples/$example -B build/$example > cmake.log 2>&1 || { cat cmake.log; fail "no find_package(taut)"; }
  cmake --build build/$example --parallel "$(nproc)" > cmake.log 2>&1 || { cat cmake.log; fail "examples/$example is not built"; }
done
taut-slam -q -i $sample.rawlog -o plugin --no-pictures --only-first-n 60 -s initialization.rest_duration=3 \
  -p build/plugin/libevery_nth.so -s features.type=example::EveryNth
build/example_read_results out

echo "-- Looking for pages and completion"
LC_ALL=C.UTF-8 man --warnings taut-slam > page
grep -q 'SYNOPSIS' page || fail "man does not show taut-slam"
bash -c 'source /usr/share/bash-completion/bash_completion
  _completion_loader taut-slam || [ $? -eq 124 ]
  complete -p taut-slam' || fail "bash-completion does not find taut-slam"

echo "-- Removing"
apt-get purge -y -qq taut >> apt.log 2>&1 || { tail apt.log; fail "apt does not remove it"; }
find / -xdev -name '*taut*' ! -path '/tmp/*' ! -path '/proc/*' ! -path '/var/cache/man/*' > after
[ ! -s after ] || { cat after; fail "files are left"; }
END
chroot "$root" /bin/bash /tmp/try.sh
echo "$package is good on a fresh Debian $(cat "$root/etc/debian_version")"
