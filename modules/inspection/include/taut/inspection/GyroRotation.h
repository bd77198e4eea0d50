#pragma once

#include <optional>
#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Imu.h"

namespace taut
{
/** The rotation that a gyro measured between any two times: its rates, linear between samples,
 * integrated once. */
class GyroRotation
{
 public:
    /** `factor` takes the rates to rad/s. Samples strictly increasing in time. */
    explicit GyroRotation(const ImuSamples& samples, double factor = 1);

    /** Rotation vector [rad] of R_{b_begin}^T R_{b_end}, in the body frame; nothing outside the
     * samples. */
    std::optional<Vector3d> between(Time begin, Time end) const;

    /** Mean body rate between two times [rad/s]. */
    std::optional<Vector3d> meanRate(Time begin, Time end) const;

    /** The longest interval between samples that overlaps [begin, end] [ns]; the whole of
     * [begin, end] if it is not within the samples. */
    Duration longestGap(Time begin, Time end) const;

 private:
    std::size_t intervalOf(Time t) const;
    Eigen::Quaterniond at(Time t) const;

    std::vector<Time> times_;
    std::vector<Vector3d> rates_;
    std::vector<Eigen::Quaterniond> rotations_;  //!< since the first sample
};
}  // namespace taut
