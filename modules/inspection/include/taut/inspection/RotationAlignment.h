#pragma once

#include <optional>
#include <vector>

#include "taut/inspection/GyroRotation.h"

namespace taut
{
/** What a LiDAR says that it turned between two times of its clock. */
struct LidarTurn
{
    Time begin = 0, end = 0;
    Vector3d turn = Vector3d::Zero();  //!< rotation vector of R_{l_begin}^T R_{l_end} [rad]
};
using LidarTurns = std::vector<LidarTurn>;

/** How a gyro's rotation is best explained by the LiDAR's:
 * gyro(begin + offset, end + offset) = R_imu_lidar * turn + bias * duration. */
struct RotationAlignment
{
    double clock_offset = 0;  //!< [s] added to the LiDAR's stamps gives the IMU's clock
    double clock_sigma = 0;   //!< [s] one standard deviation
    Matrix3d R_imu_lidar = Matrix3d::Identity();
    Matrix3d R_covariance = Matrix3d::Zero();  //!< of an error on the right, LiDAR frame [rad^2]
    Vector3d bias = Vector3d::Zero();          //!< of the gyro [rad/s]
    double unexplained = 1;  //!< share of the gyro's rotation that is left over, 0 to 1 (RMS)
    double gyro_rate = 0;    //!< RMS of the gyro's angular rate, without the bias [rad/s]
    std::size_t turns = 0;   //!< that were compared
};

struct AlignmentConfig
{
    double max_offset = 0.5;   //!< [s] either way
    double step = 0.005;       //!< [s] of the search that comes before the fit
    double max_gap = 0.25;     //!< [s] between samples; turns over a longer one are left out
    double bias_sigma = 0.05;  //!< [rad/s] prior of the gyro's bias
    std::size_t min_turns = 20;
};

/** Clock offset and extrinsic rotation between LiDAR and IMU: hand-eye calibration by rotation
 * vectors. A search over the offset, each with the best rotation in closed form (Wahba's problem,
 * by SVD), is followed by a robust Gauss-Newton fit of offset, rotation and bias together. The
 * uncertainty is the larger of the formal one and that of leaving out a tenth of the data at a time
 * (jackknife), which errors that are correlated in time do not deceive.
 *
 * About an axis around which nothing tells the rotation, it stays at `R_expected`, and R_covariance
 * is large there. Nothing if there are too few turns within the gyro's samples. */
std::optional<RotationAlignment> alignRotations(
    const LidarTurns& turns, const GyroRotation& gyro, const Matrix3d& R_expected,
    const AlignmentConfig& config = {});
}  // namespace taut
