#include "taut/simulation/Route.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace taut::simulation
{
template <class T>
std::vector<T> smoothed(std::vector<T> values, std::size_t half_window, bool periodic)
{
    const auto n = static_cast<std::ptrdiff_t>(values.size());
    const auto w = static_cast<std::ptrdiff_t>(half_window);
    const auto index = [&](std::ptrdiff_t i)
    { return periodic ? ((i % n) + n) % n : std::clamp<std::ptrdiff_t>(i, 0, n - 1); };
    for (int pass = 0; pass < 3 && n > 0; pass++)
    {
        std::vector<T> result(values);
        for (std::ptrdiff_t i = 0; i < n; i++)
        {
            T sum = values[index(i - w)];
            for (std::ptrdiff_t k = i - w + 1; k <= i + w; k++) sum += values[index(k)];
            result[i] = sum / static_cast<double>(2 * w + 1);
        }
        values.swap(result);
    }
    return values;
}
template std::vector<double> smoothed(std::vector<double>, std::size_t, bool);
template std::vector<Vector3d> smoothed(std::vector<Vector3d>, std::size_t, bool);

RoutePath::RoutePath(const Route& route, const SpeedLimits& limits)
{
    resample(route);
    computeHeadings();
    computeSpeeds(limits);
}

void RoutePath::resample(const Route& route)
{
    const std::size_t n = route.corners.size();
    double total = 0;
    for (std::size_t i = 0; i < n; i++)
        total += (route.corners[(i + 1) % n] - route.corners[i]).norm();
    if (!(total > 10 * spacing_))
        throw std::invalid_argument("the route through the world has no length (world.route)");
    const auto count = static_cast<std::size_t>(total / spacing_);
    spacing_ = total / static_cast<double>(count);

    double walked = 0;  // length up to corner i
    std::size_t i = 0;
    for (std::size_t k = 0; k < count; k++)
    {
        const double s = spacing_ * static_cast<double>(k);
        double leg = (route.corners[(i + 1) % n] - route.corners[i]).norm();
        while (i + 1 < n && s > walked + leg)
        {
            walked += leg;
            i++;
            leg = (route.corners[(i + 1) % n] - route.corners[i]).norm();
        }
        const double f = leg > 0 ? std::min(1.0, (s - walked) / leg) : 0;
        points_.push_back(route.corners[i] + f * (route.corners[(i + 1) % n] - route.corners[i]));
    }
    const auto half = static_cast<std::size_t>(std::max(1.0, route.rounding / 3 / spacing_ / 2));
    points_ = smoothed(points_, half, true);
}

void RoutePath::computeHeadings()
{
    const std::size_t n = points_.size();
    headings_.resize(n);
    const auto raw = [&](std::size_t i)
    {
        const Vector3d d = points_[(i + 1) % n] - points_[(i + n - 1) % n];
        return std::atan2(d.y(), d.x());
    };
    const auto nearest = [](double angle, double reference)
    { return angle + 2 * M_PI * std::round((reference - angle) / (2 * M_PI)); };
    headings_[0] = raw(0);
    for (std::size_t i = 1; i < n; i++) headings_[i] = nearest(raw(i), headings_[i - 1]);
    turns_ = nearest(headings_[0], headings_[n - 1]) - headings_[0];
}

void RoutePath::computeSpeeds(const SpeedLimits& limits)
{
    const std::size_t n = points_.size();
    speeds_.resize(n);
    for (std::size_t i = 0; i < n; i++)
    {
        const double next = i + 1 < n ? headings_[i + 1] : headings_[0] + turns_;
        const double curvature = std::abs(next - headings_[i]) / spacing_ + 1e-9;
        speeds_[i] = std::min(
            {limits.speed, std::sqrt(limits.lateral_acceleration / curvature),
             limits.turn_rate / curvature});
    }
    // Brake in time for what comes; twice around, so that the start knows of the end.
    for (std::size_t k = 2 * n; k-- > 0;)
    {
        const double ahead = speeds_[(k + 1) % n];
        speeds_[k % n] =
            std::min(speeds_[k % n], std::sqrt(ahead * ahead + 2 * limits.acceleration * spacing_));
    }
}

std::size_t RoutePath::cellOf(double s, double& fraction, double& lap) const
{
    const double cells = s / spacing_;
    lap = std::floor(s / length());
    const double within = cells - lap * static_cast<double>(points_.size());
    const auto i = std::min(static_cast<std::size_t>(std::max(0.0, within)), points_.size() - 1);
    fraction = within - static_cast<double>(i);
    return i;
}

Vector3d RoutePath::position(double s) const
{
    double f = 0, lap = 0;
    const std::size_t i = cellOf(s, f, lap);
    return points_[i] + f * (points_[(i + 1) % points_.size()] - points_[i]);
}

double RoutePath::heading(double s) const
{
    double f = 0, lap = 0;
    const std::size_t i = cellOf(s, f, lap);
    const double next = i + 1 < headings_.size() ? headings_[i + 1] : headings_[0] + turns_;
    return headings_[i] + f * (next - headings_[i]) + lap * turns_;
}

double RoutePath::speedLimit(double s) const
{
    double f = 0, lap = 0;
    return speeds_[cellOf(s, f, lap)];
}
}  // namespace taut::simulation
