#include "taut/trajectory/RelativeErrors.h"

#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr double kTolerance = 0.1;  // of the time or distance asked for
constexpr double kRounding = 1e-9;  // of sums of times or distances [s, m]

Pose errorBetween(const PosePair& a, const PosePair& b)
{
    const Pose truth = a.truth.inverse() * b.truth;
    return truth.inverse() * (a.estimate.inverse() * b.estimate);
}

/** Distance travelled at every pair [m]. */
std::vector<double> distancesOf(const PosePairs& pairs)
{
    std::vector<double> out;
    for (std::size_t i = 0; i < pairs.size(); i++)
        out.push_back(i == 0 ? 0 : out.back() + (pairs[i].truth.p - pairs[i - 1].truth.p).norm());
    return out;
}

/** Time of every pair since the first [s]. */
std::vector<double> timesOf(const PosePairs& pairs)
{
    std::vector<double> out;
    for (const PosePair& pair : pairs) out.push_back(toSeconds(pair.t - pairs.front().t));
    return out;
}

/** `along`: what delta is measured in, at every pair, not decreasing. */
RelativeError relativeError(const PosePairs& pairs, const std::vector<double>& along, double delta)
{
    std::vector<double> translation, rotation;
    for (std::size_t i = 0; i < pairs.size(); i++)
    {
        const double goal = along[i] + delta;
        auto j = std::lower_bound(along.begin(), along.end(), goal - kRounding);
        if (j == along.end()) break;  // else the last pose would end many pairs that are too short
        if (j != along.begin() && goal - *(j - 1) < *j - goal) --j;
        if (std::abs(*j - goal) > kTolerance * delta) continue;
        const Pose error =
            errorBetween(pairs[i], pairs[static_cast<std::size_t>(j - along.begin())]);
        translation.push_back(error.p.norm());
        rotation.push_back(angleOf(error.R) * kDegreesPerRadian);
    }
    return {delta, statisticsOf(std::move(translation)), statisticsOf(std::move(rotation))};
}

/** Adds a segment to the sums, which meanOf() divides. */
void accumulate(SegmentError& sum, double translation_percent, double rotation_deg_per_m)
{
    sum.count++;
    sum.translation_percent += translation_percent;
    sum.rotation_deg_per_m += rotation_deg_per_m;
}

SegmentError meanOf(SegmentError sum)
{
    if (sum.count == 0) return sum;
    sum.translation_percent /= static_cast<double>(sum.count);
    sum.rotation_deg_per_m /= static_cast<double>(sum.count);
    return sum;
}
}  // namespace

RelativeError relativeErrorOverTime(const PosePairs& pairs, double seconds)
{
    return relativeError(pairs, timesOf(pairs), seconds);
}

RelativeError relativeErrorOverDistance(const PosePairs& pairs, double metres)
{
    return relativeError(pairs, distancesOf(pairs), metres);
}

SegmentErrors segmentErrors(
    const PosePairs& pairs, const std::vector<double>& lengths, std::size_t step)
{
    const std::vector<double> distances = distancesOf(pairs);
    SegmentErrors out;
    for (const double length : lengths)
    {
        SegmentError sum;
        sum.length = length;
        for (std::size_t i = 0; i < pairs.size(); i += step)
        {
            const auto end =
                std::upper_bound(distances.begin(), distances.end(), distances[i] + length);
            if (end == distances.end()) break;
            const Pose error =
                errorBetween(pairs[i], pairs[static_cast<std::size_t>(end - distances.begin())]);
            const double percent = 100 * error.p.norm() / length;
            const double deg_per_m = angleOf(error.R) * kDegreesPerRadian / length;
            accumulate(sum, percent, deg_per_m);
            accumulate(out.all, percent, deg_per_m);
        }
        out.by_length.push_back(meanOf(sum));
    }
    out.all = meanOf(out.all);
    return out;
}

SegmentErrors kittiSegmentErrors(const PosePairs& pairs)
{
    return segmentErrors(pairs, {100, 200, 300, 400, 500, 600, 700, 800}, 10);
}

SegmentErrors shortSegmentErrors(const PosePairs& pairs)
{
    return segmentErrors(pairs, {5, 10, 15, 20, 25, 30, 35, 40}, 1);
}
}  // namespace taut
