#pragma once

#include "taut/core/NavState.h"
#include "taut/core/PreintegratedImu.h"

namespace taut
{
/** The IMU factor between two states (paper, equation 9 with the sign of gravity that
 * docs/equations.md explains): 15 rows in the order p, v, theta, ba, bg. The jacobians follow
 * NavState's right perturbation. */
struct ImuResidual
{
    NavState::Vector residual;    //!< [m, m/s, rad, m/s^2, rad/s]
    NavState::Matrix d_previous;  //!< by x_{k-1}
    NavState::Matrix d_current;   //!< by x_k; the biases of x_k correct the chain to first order
};

/** Residual alone, and with its jacobians. */
NavState::Vector imuResidual(
    const PreintegratedImu& imu, const NavState& previous, const NavState& current);
ImuResidual linearizeImu(
    const PreintegratedImu& imu, const NavState& previous, const NavState& current);

/** Covariance of the residual from the IMU alone: white noise and random walk of the biases. */
NavState::Matrix imuCovariance(const PreintegratedImu& imu);

/** The a-priori state at the end of the sweep: the one with zero IMU residual. */
NavState predict(const PreintegratedImu& imu, const NavState& previous);
}  // namespace taut
