#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <vector>

#include "taut/odometry/Odometry.h"

namespace taut
{
/** Scans that a start in motion looks at. */
constexpr std::size_t kBootstrapScans = 10;

/** What the first scans say of the start that they were given. */
struct Revision
{
    Vector3d velocity = Vector3d::Zero();                       //!< [m/s] is missing
    Eigen::Quaterniond level = Eigen::Quaterniond::Identity();  //!< turns gravity upright
    double gravity_error = 0;                                   //!< [m/s^2] of its norm

    double tilt() const { return Eigen::AngleAxisd(level).angle(); }  //!< [rad]

    /** Its size in what is negligible: at most 1 when map and motion agree. */
    double change() const;
};

/** Compares the results of the first scans, at least two, with the start they were given. */
Revision revisionOf(const std::vector<ScanResult>& results);

/** The start with that revision. */
NavState revised(NavState start, const Revision& revision);

/** The covariance of a start that is known as well as it was revised. */
NavState::Matrix sharpened(const NavState::Matrix& covariance, const Revision& revision);

/** How badly the scans fit the map that they make: by the cost of a match, and if matches are few.
 */
double misfitOf(const std::vector<ScanResult>& results);

/** Share of the features that found a match, over the scans that had a map to match: 0...1. */
double matchedShareOf(const std::vector<ScanResult>& results);

/** A start in motion after passes over the first scans, and how its best pass went. */
struct TriedStart
{
    Initialization start;
    double merit = std::numeric_limits<double>::infinity();  //!< misfit times change; 0 is best
    double change = 0;         //!< by that pass, in what is negligible
    double gravity_error = 0;  //!< [m/s^2] seen by that pass
    double matched = 1;        //!< share of the features

    /** Map and motion agree, and with most of what the scans see: not by chance. */
    bool convincing() const;
};
}  // namespace taut
