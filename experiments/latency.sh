#!/usr/bin/env bash
# How soon a pose is there after the last point of its scan: plays a rawlog at the sensor's pace through taut-live.
#   experiments/latency.sh LOG.rawlog [BUSY [MORE OPTIONS OF taut-live...]]
# BUSY processes compute beside it as fast as they can (default 0). Prints a row of a table: rawlog, BUSY, scans, share of
# poses within an interval between scans [%], latency [ms]: median, 99 %, worst; load [%], smallest share of a scan used [%].
set -euo pipefail
[ $# -ge 1 ] || { echo "usage: $0 LOG.rawlog [BUSY [OPTIONS...]]" >&2; exit 2; }
log=$1 busy=${2:-0}
shift $(($# < 2 ? $# : 2))
bin=${TAUT_BIN:-$(dirname "$0")/../build/release/bin}
out=$(mktemp -d)
workers=()
cleanup() {
  for worker in "${workers[@]}"; do kill "$worker" 2>/dev/null || true; done
  rm -rf "$out"
}
trap cleanup EXIT
for ((i = 0; i < busy; i++)); do
  (while :; do :; done) &
  workers+=($!)
done
code=0
"$bin/taut-live" --replay "$log" -o "$out/run" --no-pictures --no-report -v WARN "$@" || code=$?
[ "$code" -eq 0 ] || [ "$code" -eq 3 ] || exit "$code"
echo "| rawlog | busy beside | scans | in time [%] | median [ms] | 99 % [ms] | worst [ms] | load [%] | least share [%] |"
awk -v name="$(basename "$log")" -v busy="$busy" '
  /^  "live": \{/ { inside = 1; least = 1 }
  inside { gsub(/[",:]/, " ") }
  inside && $1 ~ /^(load|scans|late_scans|median|percentile_99|worst)$/ { value[$1] = $2 }
  inside && $1 == "share" && $2 < least { least = $2 }
  inside && /^  \}/ { inside = 0 }
  END {
    in_time = value["scans"] ? 100 * (1 - value["late_scans"] / value["scans"]) : 0
    printf "| %s | %d | %d | %.1f | %.0f | %.0f | %.0f | %.0f | %.0f |\n", name, busy, value["scans"], in_time,
           value["median"], value["percentile_99"], value["worst"], 100 * value["load"], 100 * least
  }' "$out/run/metrics.json"
