#pragma once

#include "taut/core/Preintegrator.h"
#include "taut/inspection/GyroRotation.h"
#include "taut/preintegration/MidpointPreintegrator.h"

namespace taut
{
/** For recordings whose IMU is not trusted yet: the gyro gives the shape of the rotation within a
 * sweep, the velocity is held, and both are given so little weight that the LiDAR alone decides
 * where a sweep ends. */
class GyroPathPreintegrator : public Preintegrator
{
    DEFINE_MRPT_OBJECT(GyroPathPreintegrator, taut)
 public:
    /** `gyro` must outlive this. `clock_offset` [s] takes the LiDAR's time to the gyro's. */
    void use(const GyroRotation& gyro, double clock_offset);

    void configure(ConfigSection& section) override { midpoint_.configure(section); }
    bool needsImu() const override { return false; }
    PreintegratedImu integrate(const PreintegrationRequest& request) const override;

 private:
    const GyroRotation* gyro_ = nullptr;
    Duration clock_offset_ = 0;
    MidpointPreintegrator midpoint_;
};
}  // namespace taut
