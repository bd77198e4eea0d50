#pragma once

#include "taut/core/PreintegratedImu.h"

namespace taut
{
/** Standard deviations of the white noise during one step of the chain, as densities. */
struct StepNoise
{
    double gyro = 0;   //!< [rad/s/sqrt(Hz)]
    double accel = 0;  //!< [m/s^2/sqrt(Hz)]
    /** The part of `gyro` that stands for what readings at the limit hide, as a density of its own.
     */
    double gyro_hidden = 0;
};

/** Adds the knot of an earlier sample to the chain and propagates the covariance of
 * (alpha, beta, theta) to it (docs/equations.md). */
void extendBackward(PreintegratedImu& chain, const ImuSample& earlier, const StepNoise& noise);

/** Starts a chain at its end t_k. */
PreintegratedImu startChain(
    const ImuSample& at_end, const Vector3d& bias_accel, const Vector3d& bias_gyro);
}  // namespace taut
