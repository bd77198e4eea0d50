#pragma once

#include <string>
#include <vector>

#include "taut/odometry/Odometry.h"

namespace taut
{
/** True if the IMU was silent for so long that what it says of the interval is one guess of
 * several. The LiDAR was silent too, or there would be states within the gap. */
bool hasLongGap(const PreintegratedImu& motion);

/** One scan against the map: the estimate of its problem, and how it is iterated. */
class Registration
{
 public:
    /** All references are kept but for `path`, the one that is predicted. `scratch` is of look-ups
     * in the map. */
    Registration(
        const OdometryConfig& config, const Map& map, const Solver& solver, MapScratch& scratch,
        Executor& executor, const NavPrior& previous, const PreintegratedImu& motion,
        const Features& features, const SweepPath& path);

    ScanProblem& problem() { return problem_; }

    /** The path by the problem's estimate. */
    const SweepPath& path() const { return path_; }

    /** The loop of the paper's Algorithm 1, from the problem's estimate on: undistort every point,
     * look up surfaces, solve, until nothing moves. `unexplained` is the covariance of (p, theta)
     * that residuals may have besides their noise. Gives why the problem cannot be solved from
     * there; empty if it can. */
    std::string iterate(LidarFactor::PoseCovariance unexplained, ScanReport& report);

    /** After a long gap: begins where most features are explained, of the prediction, what the
     * velocity before the gap says, and, if these explain less than the usual share of the
     * features, all that a vehicle or a person can have done. Gives the covariance of that guess.
     */
    LidarFactor::PoseCovariance startAfterGap(double usual_share);

 private:
    double balanceOf(int matches) const;
    std::vector<Pose> likelyPoses();

    const OdometryConfig& config_;
    const Map& map_;
    const Solver& solver_;
    MapScratch& scratch_;
    Executor& executor_;
    const NavState before_;
    const PreintegratedImu& motion_;
    const Features& features_;
    SweepPath path_;
    LidarFactor lidar_;
    ScanProblem problem_;
    std::vector<MapPoint> queries_;
    std::vector<Correspondence> correspondences_;
};
}  // namespace taut
