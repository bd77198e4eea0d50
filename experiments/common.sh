# What run.sh, job.sh and report.sh share: where things are, and what a variant is. Sourced.
# shellcheck shell=bash disable=SC2034
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bin=${TAUT_BIN:-$root/build/release/bin}
data=${TAUT_DATA:-$root/../shared/data}
modes="none rotation imu iterated-imu iterated bridge"
ablations="default fewer loose unrefined nlopt lines fixed kdtree paper"
reality="default calibrated paper"
rest=2 # s, at the start of the sweeps: for the initialisation; not scored
head="group,case,axis,level,seed,variant,status,ate_mm,ate_max_mm,rotation_deg,points_mm,points_max_mm,iterations,ms"

# Each beam looks 0.1 degrees aside and measures 1.5 cm wrong, all of them 1 cm (standard deviations).
beam_errors=(--set lidar.beam_error=0.0017 --set lidar.beam_range_error=0.015 --set lidar.range_bias=0.01)

# What of a scenario a calibration would take away: the same drive with all of it right.
calibrated=()
for key in mount_error.{x,y,z,roll,pitch,yaw} beam_error beam_range_error range_bias intensity_error incidence_error; do
  calibrated+=(--set "lidar.$key=0")
done
calibrated+=(--set imu.clock_offset=0 --set imu.clock_drift=0)

# The options of taut-slam for a variant of the method.
options_of() {
  [ "$1" = paper ] || echo "-c $root/config/default.yaml"
  case $1 in
    default | calibrated) ;;
    fewer) echo "-s features.max_points=800 -s lidar.max_insert_points=5000" ;;
    unrefined) echo "-s output.refined=false" ;;
    nlopt) echo "-s solver.type=taut::NloptSolver" ;;
    lines) echo "-s map.lines=true" ;;
    fixed) echo "-s estimation.previous_state=fixed" ;;
    kdtree) echo "-s map.type=taut::KdTreeMap" ;;
    paper) echo "-c $root/config/paper.yaml" ;;
    loose) echo "-s imu.gyro_noise=0.002 -s imu.accel_noise=0.02 -s imu.gyro_bias_walk=0.0001" \
      "-s imu.accel_bias_walk=0.001 -s preintegration.gyro_scale_error=0.002 -s preintegration.accel_scale_error=0.002" ;;
    *) echo "-s estimation.undistortion=$1" ;;
  esac
}

# The settings of a scenario over that of its axis: what makes the prior worse. The walk of "bias" moves the
# biases by 0.006 rad/s and 0.3 m/s^2 in 8 s.
prior_of() {
  case $1 in
    good) ;;
    bias) echo "imu.gyro_bias=0.05 imu.accel_bias=0.3 imu.gyro_bias_walk=0.002 imu.accel_bias_walk=0.1" ;;
    consumer) echo "imu.type=consumer" ;;
    100hz) echo "imu.rate=100" ;;
    offset) echo "imu.clock_offset=0.005" ;;
    all) echo "imu.type=consumer imu.rate=100 imu.clock_offset=0.005 imu.gyro_bias_walk=0.002 imu.accel_bias_walk=0.1" ;;
    *) echo "no such prior: $1" >&2; return 1 ;;
  esac
}

# The scenario of one place on an axis: peak angular rate [deg/s] in a hall, or speed [m/s] in a street.
scenario_of() { # AXIS LEVEL
  local shake
  case $1 in
    rate) # always at the same frequency
      shake=$(awk -v d="$2" 'BEGIN {r = d * 3.14159265 / 180; print "shake_rate: " r ", shake_acceleration: " 6.5 * r + 0.1}')
      cat <<END
world: {type: hall}
motion: {type: fast, speed: 1, start: 0.05, $shake}
lidar: {type: VLP-16, range_noise: 0.02}
END
      ;;
    speed)
      cat <<END
world: {type: street}
motion: {type: vehicle, speed: $2, acceleration: 5, shake_rate: 0.5, shake_acceleration: 2}
lidar: {type: VLP-16, range_noise: 0.02, mount: {x: 0.35, y: 0.02, z: 0.45}}
END
      ;;
    *) echo "no such axis: $1" >&2; return 1 ;;
  esac
  cat <<END
duration: 8
rest: $rest
imu: {type: industrial}
END
}
