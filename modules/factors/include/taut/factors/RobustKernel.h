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

    /** The kernel, and its derivative by e2: the weight of iteratively re-weighted least squares.
     */
    struct Judgement
    {
        double rho, weight;
    };
    Judgement judge(double e2) const
    {
        const double c2 = scale * scale;
        if (kind == Kernel::GemanMcClure)
        {
            const double left = c2 / (c2 + e2);
            return {e2 * left, left * left};
        }
        return judgeOther(e2, c2);
    }
    double rho(double e2) const { return judge(e2).rho; }
    double weight(double e2) const { return judge(e2).weight; }

    void declare(ConfigSection& section);

 private:
    Judgement judgeOther(double e2, double c2) const;
};
}  // namespace taut
