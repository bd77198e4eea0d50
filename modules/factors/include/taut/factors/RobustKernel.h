#pragma once

#include "taut/core/Config.h"

namespace taut
{
enum class Kernel
{
    None,
    Huber,
    Cauchy,
    GemanMcClure,
};

/** Robust kernel rho of a squared whitened residual e2 = |r|^2 / sigma^2. */
struct RobustKernel
{
    Kernel kind = Kernel::GemanMcClure;
    double scale = 3.0;  //!< whitened residual from which the influence falls

    double rho(double e2) const;
    /** Derivative of rho by e2: the weight of iteratively re-weighted least squares. */
    double weight(double e2) const;

    void declare(ConfigSection& section);
};
}  // namespace taut
