#!/usr/bin/env bash
# One job of run.sh: makes or finds a recording, runs all variants on it, leaves a line of CSV for each run.
#   job.sh sweep PRIOR AXIS LEVEL SEED | job.sh recording NAME | job.sh sequence SCENARIO | job.sh cost NAME ROUND
#   job.sh start PLACE LIDAR SEED | job.sh reality SCENARIO SEED
# Environment: RESULTS, the folder of the results. What has a result is not run again.
set -euo pipefail
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"
group=$1 case=$2
work=$(mktemp -d "$RESULTS/../work.XXXXXX")
trap 'rm -rf "$work"' EXIT

# Maps are not scored: made as coarse as can be. The odometry alone is: loops have slam.sh.
cheap=(-s slam.loops=false -s output.key_distance=1e4 -s output.key_angle=10 -s output.key_time=1e4 -s output.point_spacing=1)

# Names of the results: GROUP-CASE-AXIS-LEVEL-SEED-VARIANT.
result_of() { echo "$RESULTS/$group-$case-$axis-$level-$seed-$1.csv"; }

missing() {
  local variant
  for variant in $variants; do [ -s "$(result_of "$variant")" ] || return 0; done
  return 1
}

simulate() { # SCENARIO OPTIONS...: to $work/log
  "$bin/taut-simulate" -q --threads 1 -c "$1" -o "$work/log.rawlog" "${@:2}"
  log=$work/log.rawlog truth=$work/log
}

# ATE, its maximum, rotation, undistorted points and their maximum from the table of taut-evaluate.
scores_of() {
  awk '/^ATE position/ {p = $4 * 1000; m = $7 * 1000} /^ATE rotation/ {r = $4}
       /^undistorted points/ {u = $4 * 1000; w = $6 * 1000} END {print p "," m "," r "," u "," w}'
}

run() { # VARIANT
  local status=ok scores=,,,, cost=, points=() result
  result=$(result_of "$1")
  [ -s "$result" ] && return
  # shellcheck disable=SC2046
  "$bin/taut-slam" -q -w --no-pictures --no-report --threads 1 -i "$log" -o "$work/out" "${cheap[@]}" $(options_of "$1") \
    "${options[@]}" || [ $? -eq 3 ] || status=failed # 3: done, but part of the log could not be used
  [ -e "$truth.points" ] && points=(--points "$work/out/undistorted.points" --points-truth "$truth.points")
  if [ $status = ok ]; then
    "$bin/taut-evaluate" --truth "$truth.gt.tum" --estimate "$work/out/trajectory.tum" --from-time "$from" \
      "${points[@]}" >"$work/scores" || status=refused
    [ $status = ok ] && scores=$(scores_of <"$work/scores")
    cost=$(awk -F '[:,]' '/mean_iterations/ {i = $2} /mean_ms_per_scan/ {m = $2} END {print i + 0 "," m + 0}' \
      "$work/out/metrics.json")
  fi
  echo "$group,$case,$axis,$level,$seed,$1,$status,$scores,$cost" >"$result.new"
  mv "$result.new" "$result"
}

axis=- level=0 seed=0 from=0 options=()
case $group in
  sweep)
    axis=$3 level=$4 seed=$5 from=$rest variants=$modes
    # What no degraded prior can make worse is left out.
    [ "$case" = good ] || variants=${variants/none rotation /}
    missing || exit 0
    scenario_of "$axis" "$level" >"$work/scenario.yaml"
    settings=()
    for s in $(prior_of "$case"); do settings+=(--set "$s"); done
    simulate "$work/scenario.yaml" --points --seed "$seed" "${settings[@]}"
    options=(-s "initialization.rest_duration=$rest" -s output.undistorted_points=true)
    ;;
  recording)
    variants="$modes $ablations"
    log=$data/$case.rawlog truth=$data/$case
    if [ "$case" = hall_fast ]; then # the sample
      log=$root/rawlogs/$case.rawlog truth=$root/rawlogs/$case
      options=(-s initialization.rest_duration=3)
    fi
    ;;
  sequence)
    variants="$ablations imu"
    missing || exit 0
    simulate "$root/config/scenarios/$case.yaml"
    ;;
  start) # in the midst of a drive, or of a flight among trees
    axis=$3 seed=$4 variants=default
    missing || exit 0
    case $2 in
      flight) simulate "$root/config/scenarios/forest_flight.yaml" --seed "$seed" --set duration=8 --set rest=0 \
        --set "lidar.type=$3" ;;
      *) simulate "$root/config/scenarios/street_vehicle.yaml" --seed "$seed" --set duration=8 --set rest=0 \
        --set "lidar.type=$3" --set "world.type=$2" ;;
    esac
    ;;
  reality) # "calibrated": the same drive without the errors of calibration
    seed=$3 variants=$reality
    missing || exit 0
    scenario=$root/config/scenarios/$case.yaml
    simulate "$scenario" --seed "$seed"
    for variant in $variants; do [ "$variant" = calibrated ] || run "$variant"; done
    simulate "$scenario" --seed "$seed" "${calibrated[@]}"
    variants=calibrated
    ;;
  cost)
    seed=$3 variants=$modes
    log=$data/$case.rawlog truth=$data/$case options=(--to-time 25)
    ;;
esac
for variant in $variants; do run "$variant"; done
