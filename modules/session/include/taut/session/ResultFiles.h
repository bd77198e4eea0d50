#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/ThinnedSample.h"
#include "taut/odometry/Odometry.h"
#include "taut/trajectory/PointTruth.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace taut
{
/** Writes a trajectory, pose by pose, as TUM and KITTI files, and keeps what pictures need. */
class PathFiles
{
 public:
    /** `suffix` of both names. Throws std::runtime_error if a file cannot be written. */
    explicit PathFiles(const std::string& folder, const std::string& suffix = "");

    void add(const StampedPose& pose);
    void close();

    int poses() const { return poses_; }
    double length() const { return length_; }  //!< [m]
    /** Poses for pictures: thinned where the trajectory is long. */
    const std::vector<Pose>& sample() const { return sample_.items(); }
    const std::string& tumPath() const { return tum_path_; }
    const std::string& kittiPath() const { return kitti_path_; }

 private:
    std::string tum_path_, kitti_path_;
    TumWriter tum_;
    std::ofstream kitti_;
    std::optional<Pose> last_;
    ThinnedSample<Pose> sample_;
    int poses_ = 0;
    double length_ = 0;
};

/** Writes states.csv and timing.csv line by line, so that whatever ends the run, what was computed
 * up to there is on the disk. */
class ResultFiles
{
 public:
    /** `points`: undistorted.points is written too, of the results' undistorted points. Throws
     * std::runtime_error if a file cannot be written. */
    ResultFiles(const std::string& folder, bool points);

    void add(const ScanResult& result);
    void close();

 private:
    void writeState(const ScanResult& result);
    void writeTiming(const ScanResult& result);

    std::string folder_;
    std::ofstream states_, timing_;
    std::optional<PointTruthWriter> points_;
};
}  // namespace taut
