#pragma once

#include <cstdint>
#include <vector>

#include "taut/core/Correspondence.h"
#include "taut/core/Features.h"
#include "taut/core/Parallel.h"
#include "taut/core/Solver.h"
#include "taut/factors/RobustKernel.h"
#include "taut/factors/SweepPath.h"

namespace taut
{
struct LidarNoiseConfig
{
    /** Noise of a residual besides what the map says of the surface. The balance scales both. */
    double sigma = 0;  //!< [m]
    RobustKernel kernel;
};

/** How well the LiDAR residuals fit their noise. */
struct LidarFit
{
    int count = 0;       //!< correspondences used
    double chi2 = 0;     //!< sum of weight * |r|^2 / sigma^2
    double weights = 0;  //!< sum of the robust weights (rows counted)
    double reducedChi2() const { return weights > 0 ? chi2 / weights : 1; }
};

/** All point-to-line and point-to-plane residuals of one scan with point-level undistortion (paper,
 * equations 13 and 14): point j is undistorted anew by the path each time it is evaluated. */
class LidarFactor
{
 public:
    /** Features sorted by time; both references are kept. */
    LidarFactor(const Features& features, const LidarNoiseConfig& noise, Executor& executor);

    /** Covariance of an error of (p, theta) of a pose, as NavState has them. */
    using PoseCovariance = Eigen::Matrix<double, 6, 6>;

    /** One a feature. A residual can be as large as the pose predicted for the scan's end is
     * uncertain, without being an outlier: the kernel judges it by that and its noise together.
     * Where the prediction is good, false matches are told by far smaller residuals. */
    void setCorrespondences(
        const std::vector<Correspondence>& correspondences, const SweepPath& path,
        const PoseCovariance& predicted, double balance);

    /** Undistorted world positions of all features, in their order; valid until the factor is asked
     * about another path. */
    const std::vector<Vector3d>& undistort(const SweepPath& path) const
    {
        return placed(path).points;
    }

    /** Adds to the 30 x 30 Hessian and gradient of (x_{k-1}, x_k); returns the cost,
     * 1/2 sum L rho(|r|^2 / (L s^2)), s = balance sigma, where L = 1 + (prediction's variance) /
     * s^2 widens the kernel, further where the median residual is larger than that. The path's
     * derivative is exact at nodes every few milliseconds and linear between them; the residuals
     * are as exact as SampledPath. */
    double linearize(
        const SweepPath& path, double balance, ProblemMatrix& hessian,
        ProblemVector& gradient) const;

    double cost(const SweepPath& path, double balance) const;
    LidarFit fit(const SweepPath& path, double balance) const;

    /** How many features are explained by their surfaces: the sum of the weights of the residuals
     * by Geman and McClure's kernel, whatever kernel is configured, and by their noise alone,
     * neither balanced nor widened. */
    double inlierWeight(const SweepPath& path) const;

 private:
    struct Interval;
    struct Noise;
    /** The features where a path takes them. */
    struct Placed
    {
        std::uint64_t revision = 0;    //!< of the path
        std::vector<Pose> poses;       //!< of the body when each was seen
        std::vector<Vector3d> points;  //!< world frame
    };
    const Placed& placed(const SweepPath& path) const;
    Interval linearizeInterval(const Placed& placed, double balance, Time begin) const;
    Time timeOf(std::size_t i) const { return features_.stamp + features_.points[i].offset; }
    Noise noiseOf(std::size_t i, double balance) const;
    void measureExcess(const SweepPath& path, double balance);

    template <class Body>
    void forResiduals(const SweepPath& path, double balance, const Body& body) const;

    const Features& features_;
    const LidarNoiseConfig& noise_;
    Executor& executor_;
    std::vector<Correspondence> correspondences_;
    std::vector<double> predicted_variance_;  // [m^2] of each residual
    double excess_ = 1;                       // squared, of the median residual
    mutable Placed placed_;                   // by the last path: asked for several times
};
}  // namespace taut
