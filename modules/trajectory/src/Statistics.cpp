#include "taut/trajectory/Statistics.h"

#include <algorithm>
#include <cmath>

namespace taut
{
Statistics statisticsOf(std::vector<double> values)
{
    Statistics s;
    s.count = values.size();
    if (values.empty()) return s;
    const double n = static_cast<double>(s.count);
    double squares = 0;
    for (const double v : values)
    {
        s.mean += v / n;
        squares += v * v / n;
    }
    s.rmse = std::sqrt(squares);
    std::sort(values.begin(), values.end());
    s.median = (values[(s.count - 1) / 2] + values[s.count / 2]) / 2;
    s.max = values.back();
    return s;
}

double quantileOf(std::vector<double>& values, double share)
{
    if (values.empty()) return 0;
    const auto rank = std::lround(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}
}  // namespace taut
