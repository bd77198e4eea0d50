#pragma once

#include <array>
#include <memory>
#include <string>

#include "taut/core/Warning.h"
#include "taut/factors/Sweep.h"
#include "taut/odometry/OdometryConfig.h"
#include "taut/odometry/Rest.h"

namespace taut
{
/** Times of the stages of one scan [ms]. */
struct StageTimes
{
    double transform = 0, preintegrate = 0, extract = 0, match = 0, solve = 0, insert = 0;
    double total() const { return transform + preintegrate + extract + match + solve + insert; }
};

/** How a scan was matched: for reports and judgements, not for results. */
struct ScanReport
{
    std::size_t scan_points = 0;  //!< raw points used, in range and time
    int features = 0, correspondences = 0, iterations = 0;
    double inlier_weight =
        0;                 //!< of the correspondences, by their surfaces: the sum of robust weights
    double usual_fit = 0;  //!< fit() of the scans before, 0 for the first
    /** Share of the correspondences that their surfaces explain; 0 without any. */
    double fit() const { return correspondences > 0 ? inlier_weight / correspondences : 0; }
    bool converged = true;
    bool lidar_used = false;  //!< false: too few correspondences; the IMU alone moved the state
    double cost = 0, balance = 1;
    std::array<double, 3>
        translation_information{};  //!< eigenvalues of the LiDAR block, ascending [1/m^2]
    std::array<double, 3> rotation_information{};  //!< the same of the rotation [1/rad^2]
    StageTimes times;
};

/** What came of one scan. */
struct ScanResult
{
    NavEstimate estimate;  //!< x_k after this scan
    NavState previous;     //!< x_{k-1} as this scan moved it; x_{k-1} unchanged where it is held
    bool with_imu = true;  //!< false: predicted by constant velocity
    std::vector<Vector3d> points;  //!< undistorted points as inserted, world frame [m]
    Sweep sweep;                   //!< the same points raw, with their path
    /** Where OdometryConfig::keep_undistorted asks for it: each point of the raw scan in the body
     * frame at its end, along the final path [m]; NaN where it was not usable. */
    std::vector<Eigen::Vector3f> undistorted;
    ScanReport report;
};

/** True if the matches fit the map so much worse than usual that the pose is probably lost. */
bool isDoubtful(const ScanReport& report);

/** The paper's Algorithm 1: one state a scan, every point undistorted anew in every iteration.
 * Owns its map and everything behind the plug points. Not thread-safe; any number of them can work
 * at once, each with an Executor of its own. */
class Odometry
{
 public:
    Odometry(const OdometryConfig& config, Executor& executor, WarningSink warn);

    /** Starts at a state, with an empty map. */
    void start(const Initialization& initialization);
    bool started() const { return started_; }

    /** Time of the last state. */
    Time time() const { return previous_.state.t; }

    /** Estimates the state at the scan's end. `imu` should reach from time() to there; null where
     * there is no IMU: the velocity is then taken as constant. Throws std::invalid_argument if the
     * scan does not end after time(). */
    ScanResult process(const Scan& scan, const ImuSamples* imu);

    /** From the next scan on, matches and inserts this share of what it would, (0, 1]: where there
     * is no time for all of it. At 1, where it begins, nothing is left out. */
    void setShare(double share) { share_ = share; }

    /** Cells or points in the local map. */
    std::size_t mapSize() const { return map_->size(); }

 private:
    PreintegratedImu integrate(Time end, const ImuSamples* imu) const;
    void makeRateAState();
    void takeBiasesBack();
    SweepPath estimate(
        const Features& features, const PreintegratedImu& motion, const SweepPath& predicted,
        ScanResult& result);
    void judgeFit(ScanReport& report);
    std::vector<Eigen::Vector3f> undistorted(
        const Scan& raw, Time begin, const SweepPath& path) const;
    void endRestIfLeft(const NavState::Matrix& lidar_information);
    void insert(const Scan& scan, const SweepPath& path, ScanResult& result);

    OdometryConfig config_;
    std::unique_ptr<Preintegrator> preintegrator_, fallback_preintegrator_;
    std::unique_ptr<FeatureExtractor> extractor_;
    std::unique_ptr<Solver> solver_;
    std::unique_ptr<Map> map_;
    Executor& executor_;
    WarningSink warn_;
    ImuNoise noise_;
    bool started_ = false;
    double share_ = 1;
    NavPrior previous_;
    Rest rest_;
    Vector3d previous_rate_ = Vector3d::Zero();
    // Without an IMU the rate takes the place of the gyro's bias, which waits here.
    bool rate_is_state_ = false;
    Vector3d bias_gyro_ = Vector3d::Zero();
    Matrix3d bias_gyro_covariance_ = Matrix3d::Zero();
    /** Shares of late: of the features that are matched and explained, and of the matches that are.
     * 0: not known yet. */
    double usual_inlier_share_ = 0, usual_fit_ = 0;
    MapScratch scratch_;              // of look-ups in the map
    std::vector<MapPoint> inserted_;  // with the last scan; kept, since fresh memory is slow
};
}  // namespace taut
