#include "taut/factors/RobustKernel.h"

#include <cmath>

namespace taut
{
double RobustKernel::rho(double e2) const
{
    const double c2 = scale * scale;
    switch (kind)
    {
        case Kernel::Huber:
            return e2 <= c2 ? e2 : 2 * scale * std::sqrt(e2) - c2;
        case Kernel::Cauchy:
            return c2 * std::log1p(e2 / c2);
        case Kernel::GemanMcClure:
            return e2 / (1 + e2 / c2);
        case Kernel::None:
            break;
    }
    return e2;
}

double RobustKernel::weight(double e2) const
{
    const double c2 = scale * scale;
    switch (kind)
    {
        case Kernel::Huber:
            return e2 <= c2 ? 1 : scale / std::sqrt(e2);
        case Kernel::Cauchy:
            return 1 / (1 + e2 / c2);
        case Kernel::GemanMcClure:
            return 1 / ((1 + e2 / c2) * (1 + e2 / c2));
        case Kernel::None:
            break;
    }
    return 1;
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
