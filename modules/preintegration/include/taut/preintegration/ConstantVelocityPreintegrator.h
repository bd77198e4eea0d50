#pragma once

#include "taut/core/Preintegrator.h"

namespace taut
{
struct ConstantVelocityConfig
{
    double acceleration = 3.0;          //!< [m/s^2] how far the velocity may change, 1 sigma
    double angular_acceleration = 1.5;  //!< [rad/s^2] the same of the rate
    double step = 0.01;                 //!< [s] spacing of the chain's knots
};

/** For recordings without an IMU: the body keeps its twist. The samples of an IMU that would
 * measure just that are made up and integrated, so that every later stage works unchanged. */
class ConstantVelocityPreintegrator : public Preintegrator
{
    DEFINE_MRPT_OBJECT(ConstantVelocityPreintegrator, taut)
 public:
    void configure(ConfigSection& section) override;
    bool needsImu() const override { return false; }
    PreintegratedImu integrate(const PreintegrationRequest& request) const override;

    ConstantVelocityConfig config;
};
}  // namespace taut
