#include "taut/simulation/Course.h"

#include <algorithm>
#include <cmath>

#include "taut/simulation/Motion.h"

namespace taut::simulation
{
namespace
{
constexpr double kRunUp = 8.0;      // before time 0, where there is no rest [s]
constexpr double kSmoothing = 0.4;  // width of one pass [s]
}  // namespace

Course::Course(
    const Route& route, const SpeedLimits& limits, double start, double duration, double rest,
    double h)
    : path(route, limits), spacing(h), departure(rest > 0 ? rest + 4 * h : -kRunUp)
{
    const auto lead =
        static_cast<std::ptrdiff_t>(std::llround((rest > 0 ? 0 : kRunUp) / h)) + Motion::kLead;
    const auto count = static_cast<std::ptrdiff_t>(Motion::controlsFor(duration + kRunOut, h));
    // The smoothing of this and of whatever is made of it reaches back.
    const double first_step = departure + kRunOut;
    double s = start * path.length(), v = 0;
    for (std::ptrdiff_t m = -lead; m < count - Motion::kLead; m++)
    {
        times.push_back(h * static_cast<double>(m));
        lengths.push_back(s);
        if (times.back() < first_step) continue;
        v = std::min(path.speedLimit(s), v + limits.acceleration * h);
        s += v * h;
    }
    lengths = smoothed(lengths, static_cast<std::size_t>(kSmoothing / h / 2), false);
}
}  // namespace taut::simulation
