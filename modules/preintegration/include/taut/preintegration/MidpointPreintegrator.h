#pragma once

#include "taut/core/Preintegrator.h"

namespace taut
{
struct MidpointConfig
{
    /** An interval between samples of more than `gap` seconds is a gap: the motion in it may differ
     * from the interpolated one. By how much grows with the square of its length, as a smooth
     * signal leaves a straight line, up to `gap_rate` and `gap_accel` in one of `gap_time`; and
     * with the change over the gap. */
    double gap = 0.03;       //!< [s]
    double gap_rate = 1.0;   //!< [rad/s]
    double gap_accel = 5.0;  //!< [m/s^2]
    double gap_time = 1.0;   //!< [s]
    /** Errors that grow with the motion (scale factor, misalignment, samples too far apart),
     * correlated over a sweep: one standard deviation as a share of the measured value. */
    double gyro_scale_error = 0.005;
    double accel_scale_error = 0.005;
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
