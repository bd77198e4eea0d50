#include "StampJudge.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr int kMostBins = 15;         // that a sweep turns away from the one before
constexpr double kStep = 0.1;         // [m] of range: what fits so well is the same surface
constexpr double kLeastTurn = 0.3;    // [rad] root of the summed squares: less tells nothing
constexpr double kExplained = 0.3;    // of the squares: what the better guess may leave
constexpr double kLeastRatio = 1.15;  // of what the worse guess leaves to the better one
constexpr double kEvidence = 12;      // twice the logarithm of their likelihoods' ratio
constexpr int kFewestPairs = 20;

/** How badly a panorama fits to another, turned by some bins. */
double misfitOf(const Panorama& a, const Panorama& b, int bins)
{
    double sum = 0, count = 0;
    for (int row = 0; row < Panorama::kRows; row++)
        for (int i = 0; i < Panorama::kBins; i++)
        {
            const double ra = a.range(row, i + bins), rb = b.range(row, i);
            if (ra <= 0 || rb <= 0) continue;
            sum += std::log1p(square((ra - rb) / kStep));
            count++;
        }
    return count > 0 ? sum / count : 0;
}

/** How far the sensor turned about its axis between two views [rad]; nothing if too far. */
std::optional<double> turnBetween(const Panorama& a, const Panorama& b)
{
    std::vector<double> misfits;
    for (int bins = -kMostBins; bins <= kMostBins; bins++) misfits.push_back(misfitOf(a, b, bins));
    const auto best = std::min_element(misfits.begin(), misfits.end());
    if (best == misfits.begin() || best == misfits.end() - 1) return {};
    const double before = *(best - 1), after = *(best + 1);
    const double bend = before - 2 * *best + after;
    const double between = bend > 0 ? (before - after) / (2 * bend) : 0;
    const auto bins = static_cast<double>(best - misfits.begin()) - kMostBins + between;
    return bins * 2 * M_PI / Panorama::kBins;
}
}  // namespace

void StampJudge::add(Time first, Time second, const Panorama& of_first, const Panorama& of_second)
{
    if (const auto angle = turnBetween(of_first, of_second))
        turned_.push_back({first, second, *angle});
}

/** What the gyro turned from one sweep to the next, as a mean over their points: rates count less
 * the farther they are from the time between the sweeps. */
std::optional<Vector3d> StampJudge::gyroAngle(Time middle, Duration half) const
{
    const auto earlier = [](const ImuSample& s, Time t) { return s.t < t; };
    const auto begin = std::lower_bound(samples_.begin(), samples_.end(), middle - half, earlier);
    Vector3d sum = Vector3d::Zero();
    double weights = 0;
    auto it = begin;
    for (; it != samples_.end() && it->t < middle + half; ++it)
    {
        const double weight =
            1 - std::abs(static_cast<double>(it->t - middle)) / static_cast<double>(half);
        sum += weight * it->gyro;
        weights += weight;
    }
    if (begin == samples_.begin() || it == samples_.end() || !(weights > 1)) return {};
    return Vector3d(sum / weights * toSeconds(half));
}

/** If views turn by a fixed part of each axis of the gyro. */
StampJudge::Misfit StampJudge::misfit(Duration interval, double shift) const
{
    Matrix3d hessian = 1e-9 * Matrix3d::Identity();
    Vector3d gradient = Vector3d::Zero();
    Misfit result;
    for (const Turned& turned : turned_)
    {
        const Duration apart = turned.second - turned.first;
        if (std::abs(apart - interval) > interval / 4) continue;
        const auto gyro = gyroAngle(
            turned.second + std::llround(shift * static_cast<double>(interval)), interval);
        if (!gyro) continue;
        hessian += *gyro * gyro->transpose();
        gradient += turned.angle * *gyro;
        result.all += square(turned.angle);
        result.count++;
    }
    result.rest = result.all - gradient.dot(hessian.ldlt().solve(gradient));
    return result;
}

std::optional<bool> StampJudge::isEnd(Duration interval) const
{
    // The time between two sweeps is the stamp of the second if stamps are begins, that of the
    // first if they are ends.
    const Misfit if_begin = misfit(interval, 0), if_end = misfit(interval, -1);
    const int count = std::min(if_begin.count, if_end.count);
    if (count < kFewestPairs || if_begin.all < square(kLeastTurn)) return {};
    const bool is_end = if_end.rest < if_begin.rest;
    const Misfit& better = is_end ? if_end : if_begin;
    const double ratio = std::max(if_begin.rest, if_end.rest) / std::max(better.rest, 1e-12);
    if (better.rest > kExplained * better.all || ratio < kLeastRatio ||
        count * std::log(ratio) < kEvidence)
        return {};
    return is_end;
}
}  // namespace taut
