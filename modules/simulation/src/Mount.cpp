#include "taut/simulation/Mount.h"

#include <cmath>

#include "taut/simulation/Lidar.h"
#include "taut/simulation/Random.h"

namespace taut::simulation
{
Mount::Mount(const LidarConfig& config, std::uint64_t seed)
    : told_(config.T_imu_lidar),
      true_(config.T_imu_lidar),
      wrong_(!config.mount_error.p.isZero(0) || !config.mount_error.R.isIdentity(0)),
      soft_(config.soft_mount)
{
    if (wrong_) true_ = told_ * config.mount_error;
    Random random(seed, 31);
    for (double& phase : phases_) phase = random.uniform(0, 2 * M_PI);
}

Pose Mount::at(double t) const
{
    if (!soft()) return true_;
    Vector3d about, along;
    for (int axis = 0; axis < 3; axis++)
    {
        const double angle = 2 * M_PI * soft_.frequency * t;
        const auto i = static_cast<std::size_t>(axis);
        about[axis] = soft_.angle * std::sin(angle + phases_[i]);
        along[axis] = soft_.displacement * std::sin(angle + phases_[i + 3]);
    }
    return true_ * Pose{expSO3(about), along};
}

Eigen::Vector3f Mount::corrected(const Eigen::Vector3f& recorded, double t) const
{
    if (!wrong_ && !soft()) return recorded;
    return (told_.inverse() * (at(t) * recorded.cast<double>())).cast<float>();
}

void declare(ConfigSection& section, SoftMount& mount)
{
    section.key("frequency", mount.frequency, {0, 1000}, "Hz, of the LiDAR against the IMU");
    section.key("angle", mount.angle, {0, 0.5}, "rad, amplitude about each axis");
    section.key("displacement", mount.displacement, {0, 0.5}, "m, amplitude along each axis");
}

Pose declarePose(ConfigSection& section, const Vector3d& p, const Vector3d& degrees)
{
    constexpr double degree = M_PI / 180;
    Pose T;
    T.p = p;
    Vector3d angles = degrees;
    section.key("x", T.p.x(), kAnyNumber, "m");
    section.key("y", T.p.y(), kAnyNumber, "m");
    section.key("z", T.p.z(), kAnyNumber, "m");
    section.key("roll", angles.x(), {-180, 180}, "degrees");
    section.key("pitch", angles.y(), {-180, 180}, "degrees");
    section.key(
        "yaw", angles.z(), {-180, 180}, "degrees; applied first yaw, then pitch, then roll");
    T.R = expSO3(Vector3d(0, 0, angles.z() * degree)) *
          expSO3(Vector3d(0, angles.y() * degree, 0)) * expSO3(Vector3d(angles.x() * degree, 0, 0));
    return T;
}
}  // namespace taut::simulation
