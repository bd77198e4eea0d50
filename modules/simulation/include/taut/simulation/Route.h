#pragma once

#include <vector>

#include "taut/core/Geometry.h"

namespace taut::simulation
{
/** A closed way through a world, on its ground: the body moves along it and never leaves it by more
 * than its sway. */
struct Route
{
    std::vector<Vector3d> corners;  //!< polyline, the last corner joins the first [m]
    double rounding = 1.0;          //!< length over which corners are rounded [m]
};

/** How fast a body may go along a route. */
struct SpeedLimits
{
    double speed = 1;                 //!< [m/s]
    double acceleration = 1;          //!< along the route [m/s^2]
    double lateral_acceleration = 1;  //!< [m/s^2]
    double turn_rate = 1;             //!< [rad/s]
};

/** A route by its arc length, resampled, rounded and with the speed allowed at every place. */
class RoutePath
{
 public:
    /** Throws std::invalid_argument on a route without length. */
    RoutePath(const Route& route, const SpeedLimits& limits);

    double length() const { return spacing_ * static_cast<double>(points_.size()); }  //!< [m]
    Vector3d position(double s) const;  //!< periodic in s
    double heading(double s) const;     //!< [rad], continuous: grows by whole turns a lap
    double speedLimit(double s) const;  //!< [m/s]

 private:
    void resample(const Route& route);
    void computeHeadings();
    void computeSpeeds(const SpeedLimits& limits);
    std::size_t cellOf(double s, double& fraction, double& lap) const;

    double spacing_ = 0.05;
    double turns_ = 0;  // heading gained in one lap [rad]
    std::vector<Vector3d> points_;
    std::vector<double> headings_, speeds_;
};

/** Centred moving average of a periodic or clamped series, three passes: a smooth kernel. */
template <class T>
std::vector<T> smoothed(std::vector<T> values, std::size_t half_window, bool periodic);
}  // namespace taut::simulation
