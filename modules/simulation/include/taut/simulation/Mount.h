#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "taut/core/Config.h"
#include "taut/core/Geometry.h"

namespace taut::simulation
{
struct LidarConfig;

/** A mount that gives way: the LiDAR vibrates against the IMU, by a sinusoid of its own phase about
 * and along each axis. */
struct SoftMount
{
    double frequency = 0;     //!< [Hz]
    double angle = 0;         //!< amplitude about each axis [rad]
    double displacement = 0;  //!< amplitude along each axis [m]
};

/** How the LiDAR truly is mounted, other than the recording says. */
class Mount
{
 public:
    Mount(const LidarConfig& config, std::uint64_t seed);

    /** True T_imu_lidar at time t [s]. */
    Pose at(double t) const;

    /** Where a point recorded at time t [s] would be if the recording told the mount right; both in
     * the frame of the LiDAR as the recording has it [m]. */
    Eigen::Vector3f corrected(const Eigen::Vector3f& recorded, double t) const;

 private:
    bool soft() const { return soft_.angle > 0 || soft_.displacement > 0; }

    Pose told_, true_;
    bool wrong_;
    SoftMount soft_;
    std::array<double, 6> phases_{};
};

void declare(ConfigSection& section, SoftMount& mount);

/** A pose as keys x, y, z [m], roll, pitch, yaw [degrees]; applied first yaw, then pitch, then
 * roll. */
Pose declarePose(ConfigSection& section, const Vector3d& p, const Vector3d& degrees);
}  // namespace taut::simulation
