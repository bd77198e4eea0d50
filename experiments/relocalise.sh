#!/usr/bin/env bash
# Finds the first pose in a known map from a few seconds of data, again and again: simulates a place and another day
# in it, maps the first, and starts in the second at times that are spread over it.
#   experiments/relocalise.sh [-n STARTS] [-t SECONDS] [-o FOLDER] [-c "FIRST:SECOND ..."]
#     -n  starts of each place (default 20)     -t  data of a start [s] (default 5)
#     -o  folder of results (default out/experiments/relocalise)
#     -c  scenarios of the map and of the other day (default: halls_walk and blocks_vehicle, each with its later one)
# A start is right if the last pose is within 0.3 m and 3 degrees of the truth, in the frame of the map.
set -euo pipefail
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"
starts=20 seconds=5 out=$root/out/experiments/relocalise places=
while getopts n:t:o:c: option; do
  case $option in
    n) starts=$OPTARG ;;
    t) seconds=$OPTARG ;;
    o) out=$OPTARG ;;
    c) places=$OPTARG ;;
    *) sed -n '2,/^set/{/^#/p}' "$0" >&2; exit 2 ;;
  esac
done
mkdir -p "$out"
places=${places:-"halls_walk:halls_walk_later blocks_vehicle:blocks_vehicle_later"}

simulate() { # SCENARIO
  [ -s "$out/$1.rawlog" ] ||
    "$bin/taut-simulate" -q -c "$root/config/scenarios/$1.yaml" -o "$out/$1.rawlog" "${beam_errors[@]}"
}

start() { # FIRST SECOND FROM: prints "not found", or the error of the last pose [m, degrees]
  local code=0 end
  end=$(awk -v a="$3" -v b="$seconds" 'BEGIN {print a + b}')
  "$bin/taut-slam" -q -w --no-pictures --no-report -i "$out/$2.rawlog" -o "$out/start" -m "$out/$1" --localize \
    --from-time "$3" --to-time "$end" || code=$?
  if [ "$code" -ne 0 ] && grep -q '"place_unknown"' "$out/start/metrics.json"; then
    echo "not found"
  elif [ "$code" -ne 0 ] && [ "$code" -ne 3 ]; then
    echo "failed"
  else
    # The last second alone: the error where the body is now.
    { head -1 "$out/start/trajectory.tum"; tail -10 "$out/start/trajectory.tum"; } >"$out/last.tum"
    "$bin/taut-evaluate" --truth "$out/$2.gt.tum" --estimate "$out/last.tum" --min-coverage 0 --min-poses 1 \
      --frame-truth "$out/$1.gt.tum" --frame-estimate "$out/$1/trajectory.tum" 2>/dev/null |
      awk '/^ATE position/ {p = $4} /^ATE rotation/ {r = $4} END {print p, r}'
  fi
}

echo "| map | other day | starts | right | not found | wrong | median error [mm] |"
echo "|---|---|---|---|---|---|---|"
for place in $places; do
  first=${place%:*} second=${place#*:}
  simulate "$first"
  simulate "$second"
  [ -s "$out/$first/graph.g2o" ] || "$bin/taut-slam" -q -w --no-pictures --no-report -i "$out/$first.rawlog" -o "$out/$first" || [ $? -eq 3 ]
  begin=$(awk '!/^#/ {print $1; exit}' "$out/$second.gt.tum") end=$(awk 'END {print $1}' "$out/$second.gt.tum")
  : >"$out/$second.starts"
  for k in $(seq "$starts"); do
    # After the rest of the simulated start, evenly spread and off the second.
    from=$(awk -v k="$k" -v n="$starts" -v a="$begin" -v b="$end" -v s="$seconds" \
      'BEGIN {span = b - a - 13 - s; printf "%.2f", 12 + span * (k - 0.37) / n}')
    echo "$from $(start "$first" "$second" "$from")" >>"$out/$second.starts"
  done
  sort -k2,2g "$out/$second.starts" | awk -v first="$first" -v second="$second" '
    /not found/ {lost++; next}
    /failed/ {wrong++; next}
    $2 < 0.3 && $3 < 3 {error[++right] = 1000 * $2; next}
    {wrong++}
    END {printf "| %s | %s | %d | %d | %d | %d | %.0f |\n", first, second, NR, right, lost, wrong, error[int((right + 1) / 2)]}'
done
