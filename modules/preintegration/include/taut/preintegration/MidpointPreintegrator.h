#pragma once

#include "taut/core/Preintegrator.h"

namespace taut
{
struct MidpointConfig
{
    /** Rates and accelerations that an IMU gap leaves unknown: within an interval between samples
     * of more than `gap` seconds the motion may have differed by so much from the interpolated one.
     */
    double gap = 0.03;       //!< [s]
    double gap_rate = 1.0;   //!< [rad/s]
    double gap_accel = 5.0;  //!< [m/s^2]
    /** Errors that grow with the motion (scale factor, misalignment, samples too far apart),
     * correlated over a sweep: one standard deviation as a share of the measured value. */
    double gyro_scale_error = 0.002;
    double accel_scale_error = 0.002;
};

/** Backward mid-point preintegration of IMU samples (paper, equation 8). The samples are
 * interpolated at both ends of the interval; where they do not reach an end, the nearest one is
 * held. */
class MidpointPreintegrator : public Preintegrator
{
    DEFINE_MRPT_OBJECT(MidpointPreintegrator, taut)
 public:
    void configure(ConfigSection& section) override;
    bool needsImu() const override { return true; }
    PreintegratedImu integrate(const PreintegrationRequest& request) const override;

    MidpointConfig config;
};
}  // namespace taut
