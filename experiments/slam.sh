#!/usr/bin/env bash
# Loops against the truth: simulates drives whose beams err as real ones do, closes loops, scores both. Prints a table.
# Each run leaves a line of its own, so that it goes on where it was stopped.
#   experiments/slam.sh [-s SEEDS] [-o FOLDER] [-c "SCENARIO[:SECONDS] ..."]
#     -s  seeds a scenario (default 1)      -o  folder of results (default out/experiments/slam)
# Called by `experiments/run.sh -g slam` with the seeds that are asked for there.
set -euo pipefail
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"
seeds=1 out=$root/out/experiments/slam scenarios=
while getopts s:o:c: option; do
  case $option in
    s) seeds=$OPTARG ;;
    o) out=$OPTARG ;;
    c) scenarios=$OPTARG ;;
    *) sed -n '2,/^set/{/^#/p}' "$0" >&2; exit 2 ;;
  esac
done
mkdir -p "$out"
work=$(mktemp -d "$out/work.XXXXXX")
trap 'rm -rf "$work"' EXIT

scenarios=${scenarios:-"storeys_walk blocks_vehicle halls_walk field_walk tunnel_vehicle street_vehicle:110 corridor_walk:120 forest_flight:100"}

run() { # SCENARIO SECONDS SEED
  local result=$out/$1-$3.row duration=()
  [ -s "$result" ] && return
  [ -z "$2" ] || duration=(--duration "$2")
  "$bin/taut-simulate" -q -c "$root/config/scenarios/$1.yaml" -o "$work/log.rawlog" --seed "$3" "${duration[@]}" "${beam_errors[@]}"
  "$bin/taut-slam" -q -w --no-pictures --no-report -i "$work/log.rawlog" -o "$work/out" || [ $? -eq 3 ]
  "$bin/taut-evaluate" --truth "$work/log.gt.tum" --estimate "$work/out/trajectory_odometry.tum" >"$work/before"
  "$bin/taut-evaluate" --truth "$work/log.gt.tum" --estimate "$work/out/trajectory.tum" --loops "$work/out" >"$work/after"
  awk -v name="$1" -v seed="$3" '
    FILENAME ~ /before$/ && /^ATE position/ {before = 1000 * $4}
    FILENAME ~ /after$/ && /^ATE position/ {after = 1000 * $4}
    /^loops/ {loops = $2; wrong = $6}
    /^revisits/ {revisits = $2; found = $4}
    /^errors/ {largest = 1000 * $3; nees = $6}
    /"mean_ms_per_scan"/ {ms = $2 + 0}
    /"poses"/ {poses = $2 + 0}
    /"seconds"/ {slam = $2 + 0}
    END {
      printf "| %s | %d | %d | %d | %d of %d | %.0f | %.2f | %.0f | %.0f | %.0f %% |\n", name, seed, loops, wrong, found,
        revisits, largest, nees, before, after, 100 * slam / (ms * poses / 1000)
    }' "$work/before" "$work/after" "$work/out/metrics.json" >"$result"
}

for scenario in $scenarios; do
  for seed in $(seq "$seeds"); do
    duration=${scenario#*:}
    [ "$duration" != "$scenario" ] || duration=
    run "${scenario%:*}" "$duration" "$seed" || echo "${scenario%:*} $seed failed" >&2
  done
done
echo "| scenario | seed | loops | wrong | revisits found | largest error [mm] | NEES | ATE odometry [mm] | ATE [mm] | time of the odometry |"
echo "|---|---|---|---|---|---|---|---|---|---|"
cat "$out"/*.row
