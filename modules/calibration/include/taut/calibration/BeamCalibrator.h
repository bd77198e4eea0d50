#pragma once

#include <Eigen/Core>
#include <vector>

#include "taut/core/Beams.h"
#include "taut/factors/Sweep.h"

namespace taut
{
struct BeamCalibrationConfig
{
    std::size_t points = 4000;       //!< of a sweep that are used
    double window = 20;              //!< [s] of sweeps whose points are held against each other
    double range_noise = 0.02;       //!< [m] of a return, besides its beam's error
    double elevation_prior = 0.005;  //!< [rad] that a beam may be off, one standard deviation
    double range_prior = 0.05;       //!< [m]
};

/** What was found of one beam. */
struct CalibratedBeam
{
    double elevation = 0, range = 0;  //!< to be added [rad, m]
    /** One standard deviation, by how far two halves of the data differ; the prior's where nothing
     * shows it. */
    double elevation_sigma = 0, range_sigma = 0;
    bool elevation_shown = false, range_shown = false;  //!< surfaces tell it
};

/** Finds how far each beam of a LiDAR is off its nominal elevation and range, from how its points
 * lie to surfaces that other beams see too.
 *
 * The points of a window of sweeps are put into voxels, along the path that the odometry found. In
 * a voxel that holds a plane, each point's distance to it is linear in the errors of its beam. The
 * plane itself is unknown, and its three parameters are eliminated: what is left tells beams
 * against each other. Paths are held fixed; the caller runs the odometry again with what was found,
 * until that is little (docs/equations.md). Not thread-safe. */
class BeamCalibrator
{
 public:
    /** `applied`: corrections that the sweeps have already; what is found is on top of these, and
     * their sum is held by the prior. */
    BeamCalibrator(const BeamCalibrationConfig& config, int rings, BeamCorrections applied = {});

    /** The next sweep, whose end is final. Its points have rings. */
    void add(const Sweep& sweep, const NavState& end);

    /** No more sweeps. One result a ring, with what was applied in it. */
    std::vector<CalibratedBeam> finish();

    /** [m] root mean square of the points' distances from their planes: before, and as the
     * corrections that were found make them. After finish(). */
    double thicknessBefore() const;
    double thicknessAfter() const;

 private:
    struct Observed
    {
        Vector3d point;  // world frame
        BeamDerivative derivative;
        std::uint16_t ring;
    };
    using Points = std::vector<Observed>;
    /** Normal equations of one half of the data: elevation and range of ring r at 2r, 2r + 1. */
    struct Equations
    {
        Eigen::MatrixXd hessian;
        Eigen::VectorXd gradient;
        double cost = 0, weight = 0;
    };

    void closeWindow();
    void addVoxel(
        Points::iterator begin, Points::iterator end, const Vector3d& corner, double edge);
    void addPlane(
        const Points::iterator begin, const Points::iterator end, const Vector3d& middle,
        const Vector3d& normal);
    Eigen::VectorXd solve(const Equations& equations) const;

    BeamCalibrationConfig config_;
    int rings_;
    BeamCorrections applied_;
    Points window_;
    Time window_begin_ = 0;
    std::size_t windows_ = 0;
    Equations halves_[2];
    double cost_before_ = 0, cost_after_ = 0, weight_ = 0;
};
}  // namespace taut
