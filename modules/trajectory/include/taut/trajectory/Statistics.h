#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace taut
{
inline constexpr double kDegreesPerRadian = 180 / M_PI;

struct Statistics
{
    std::size_t count = 0;
    double rmse = 0, mean = 0, median = 0, max = 0;
};

/** Of values >= 0; all zero where there are none. */
Statistics statisticsOf(std::vector<double> values);

/** The value that a share (0..1) of the values does not exceed: the one of rank share (n - 1),
 * rounded. 0 where there are none. Changes the order of the values. */
double quantileOf(std::vector<double>& values, double share);
}  // namespace taut
