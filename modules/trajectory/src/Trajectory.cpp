#include "taut/trajectory/Trajectory.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace taut
{
void requireIncreasing(const Trajectory& trajectory)
{
    for (std::size_t i = 1; i < trajectory.size(); i++)
        if (trajectory[i].t <= trajectory[i - 1].t)
            throw std::invalid_argument(
                "time does not increase: pose " + std::to_string(i) + " at " +
                std::to_string(trajectory[i].t) + " ns follows one at " +
                std::to_string(trajectory[i - 1].t) + " ns");
}

Duration medianSpacing(const Trajectory& trajectory)
{
    if (trajectory.size() < 2) return 0;
    std::vector<Duration> spacings;
    for (std::size_t i = 1; i < trajectory.size(); i++)
        spacings.push_back(trajectory[i].t - trajectory[i - 1].t);
    const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
    std::nth_element(spacings.begin(), middle, spacings.end());
    return *middle;
}

double pathLength(const Trajectory& trajectory)
{
    double sum = 0;
    for (std::size_t i = 1; i < trajectory.size(); i++)
        sum += (trajectory[i].T_world_imu.p - trajectory[i - 1].T_world_imu.p).norm();
    return sum;
}

double angleOf(const Matrix3d& R)
{
    return logSO3(R).norm();
}
}  // namespace taut
