#!/usr/bin/env bash
# From a fresh Debian 12 to a trajectory, a map and pictures of a small recording with known truth.
set -euo pipefail
cd "$(dirname "$0")"
cmake/install-dependencies.sh
cmake --preset release
cmake --build --preset release --target taut-slam taut-evaluate

out=$PWD/out/demo
programs=build/release/bin
# The recording rests for 3 s before it moves.
"$programs/taut-slam" -i rawlogs/hall_fast.rawlog -o "$out" -w -s initialization.rest_duration=3 \
  --truth rawlogs/hall_fast.gt.tum
echo
echo "Accuracy, against the truth of the simulation:"
"$programs/taut-evaluate" --truth rawlogs/hall_fast.gt.tum --estimate "$out/trajectory.tum"
cat <<END

trajectory  $out/trajectory.tum
map         $out/map.ply (points), $out/map.bt and $out/map.ot (OctoMap: open in octovis)
pictures    $out/snapshot_top.png, snapshot_oblique.png and snapshot_follow.png beside it
page        $out/report.html: all of it in a browser
END
