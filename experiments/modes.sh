#!/usr/bin/env bash
# Runs all six undistortion modes on recordings with truth and prints a table (Markdown).
#   experiments/modes.sh [-c METHOD.yaml] RECORDING.rawlog ...     (the truth beside each: RECORDING.gt.tum)
# Without recordings: hall_violent and handheld_real_imu of $TAUT_DATA (default ../shared/data).
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
bin=${TAUT_BIN:-$root/build/release/bin}
data=${TAUT_DATA:-$root/../shared/data}
method=$root/config/default.yaml
if [ "${1:-}" = -c ]; then method=$2; shift 2; fi
[ $# -gt 0 ] || set -- "$data/hall_violent.rawlog" "$data/handheld_real_imu.rawlog"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

echo "| recording | undistortion | ATE RMSE [mm] | ATE max [mm] | rotation RMSE [deg] | iterations | ms a scan |"
echo "|---|---|---|---|---|---|---|"
for log in "$@"; do
  name=$(basename "$log" .rawlog)
  for mode in none rotation imu iterated-imu iterated bridge; do
    "$bin/taut-slam" -q -w --no-pictures -c "$method" -s estimation.undistortion=$mode \
      -i "$log" -o "$out/$name"
    scores=$("$bin/taut-evaluate" --truth "${log%.rawlog}.gt.tum" --estimate "$out/$name/trajectory.tum" |
      awk '/^ATE position/ {p = $4; max = $7} /^ATE rotation/ {r = $4}
           END {printf "%.2f | %.1f | %.3f", 1000 * p, 1000 * max, r}')
    cost=$(awk -F '[:,]' '/mean_iterations/ {i = $2} /mean_ms_per_scan/ {ms = $2}
           END {printf "%.2f | %.1f", i, ms}' "$out/$name/metrics.json")
    echo "| $name | $mode | $scores | $cost |"
  done
done
