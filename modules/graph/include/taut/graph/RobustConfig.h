#pragma once

#include "taut/core/Config.h"

namespace taut
{
/** Graduated non-convexity with truncated least squares (Yang et al., 2020) on loop closures. */
struct RobustConfig
{
    bool robust = true;
    double outlier_chi2 =
        16.8;             //!< c^2: beyond it a closure is false; 99 % of 6 degrees of freedom
    double growth = 1.4;  //!< of mu, from one solution to the next

    void declare(ConfigSection& section);
};

/** Weight of a closure: 1 up to chi2 = c^2 mu / (mu + 1), 0 from c^2 (mu + 1) / mu, and
 * c sqrt(mu (mu + 1) / chi2) - mu in between. For mu to infinity: 1 below c^2, 0 above. */
double truncatedWeight(double chi2, double outlier_chi2, double mu);
}  // namespace taut
