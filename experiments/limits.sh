#!/usr/bin/env bash
# An IMU at its limit, a noisy one and none: limits.sh [-s SEEDS] [-j JOBS] prints a table of the errors over the seeds.
# Recordings are simulated into a folder that is removed.
set -euo pipefail
. "$(dirname "$0")/common.sh"
seeds=3 jobs=2
while getopts s:j: option; do
  case $option in
    s) seeds=$OPTARG ;;
    j) jobs=$OPTARG ;;
    *) sed -n 2,3p "$0" >&2; exit 2 ;;
  esac
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# NAME | scenario | options of taut-simulate | options of taut-slam
cases="gyro ends at 250 deg/s, 32 rings|hall_clipped||
gyro ends at 250 deg/s, 16 rings|hall_clipped|--set lidar.type=VLP-16|
gyro ends at 125 deg/s, 16 rings|hall_clipped|--set lidar.type=VLP-16 --set imu.gyro_range=2.18|
gyro ends at 250 deg/s, IMU at 100 Hz, 16 rings|hall_clipped|--set lidar.type=VLP-16 --set imu.rate=100|
accelerometer ends at 2 g, 16 rings|hall_clipped|--set lidar.type=VLP-16 --set imu.gyro_range=50 --set imu.accel_range=19.62|
noisy IMU, walking along a corridor|corridor_walk|--duration 40 --set imu.gyro_noise=0.003 --set imu.accel_noise=0.03|
no IMU, hall, 3 rad/s|hall_fast|--duration 20 --set lidar.dropout=0|-s preintegration.type=taut::ConstantVelocityPreintegrator
no IMU, hall, 8 rad/s|hall_violent|--duration 30|-s preintegration.type=taut::ConstantVelocityPreintegrator
no IMU, walking along a corridor|corridor_walk|--duration 40|-s preintegration.type=taut::ConstantVelocityPreintegrator"

one() { # NUMBER SEED
  local number=$1 seed=$2 name scenario simulate slam out=$work/$1-$2
  IFS='|' read -r name scenario simulate slam < <(sed -n "${number}p" <<< "$cases")
  # shellcheck disable=SC2086
  "$bin/taut-simulate" -q -c "$root/config/scenarios/$scenario.yaml" -o "$out.rawlog" --seed "$seed" $simulate
  # shellcheck disable=SC2086
  "$bin/taut-slam" -q -i "$out.rawlog" -o "$out" --no-report --no-pictures -s slam.loops=false $slam > "$out.log" 2>&1 || true
  "$bin/taut-evaluate" --estimate "$out/trajectory.tum" --truth "$out.gt.tum" > "$out.score" 2>&1 || true
  rm -rf "$out.rawlog" "$out"
}
export -f one
export work cases bin root

count=$(wc -l <<< "$cases")
for number in $(seq "$count"); do
  for seed in $(seq "$seeds"); do echo "$number $seed"; done
done | xargs -P "$jobs" -L 1 bash -c 'one "$0" "$1"'

echo "| case | ATE [mm], each of $seeds seeds | largest error [mm] |"
echo "|---|---|---|"
for number in $(seq "$count"); do
  name=$(sed -n "${number}s/|.*//p" <<< "$cases")
  awk -v name="$name" '
    FNR == 1 { runs++ }
    $1 == "ATE" && $2 == "position" { errors = errors sprintf("%s%.1f", scored++ ? ", " : "", 1e3 * $4); if ($7 > most) most = $7 }
    END { if (scored < runs) errors = errors " (" runs - scored " lost)"; printf "| %s | %s | %.0f |\n", name, errors, 1e3 * most }
  ' "$work/$number"-*.score
done
