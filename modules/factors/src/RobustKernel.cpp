#include "taut/factors/RobustKernel.h"

#include <cmath>

namespace taut
{
RobustKernel::Judgement RobustKernel::judgeOther(double e2, double c2) const
{
    switch (kind)
    {
        case Kernel::Huber:
            if (e2 > c2) return {2 * scale * std::sqrt(e2) - c2, scale / std::sqrt(e2)};
            break;
        case Kernel::Cauchy:
            return {c2 * std::log1p(e2 / c2), 1 / (1 + e2 / c2)};
        case Kernel::GemanMcClure:  // see judge()
        case Kernel::None:
            break;
    }
    return {e2, 1};
}

void RobustKernel::declare(ConfigSection& section)
{
    section.choice<Kernel>(
        "kernel", kind,
        {{"none", Kernel::None},
         {"huber", Kernel::Huber},
         {"cauchy", Kernel::Cauchy},
         {"geman-mcclure", Kernel::GemanMcClure}},
        "robust kernel of the LiDAR residuals");
    section.key("kernel_scale", scale, kPositive, "sigmas, where the influence starts to fall");
}
}  // namespace taut
