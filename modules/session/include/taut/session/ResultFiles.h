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
/** Writes trajectory.tum, trajectory_kitti.txt, states.csv and timing.csv line by line, so that
 * whatever ends the run, what was computed up to there is on the disk. */
class ResultFiles
{
 public:
    /** `points`: undistorted.points is written too, of the results' undistorted points. Throws
     * std::runtime_error if a file cannot be written. */
    ResultFiles(const std::string& folder, bool points);

    /** The next line of states.csv and timing.csv. */
    void add(const ScanResult& result);
    /** The next pose of the trajectory. */
    void addPose(const StampedPose& pose);
    void close();

    int poses() const { return poses_; }
    double length() const { return length_; }  //!< [m]
    /** Poses for pictures: thinned where the trajectory is long. */
    const std::vector<Pose>& sample() const { return sample_.items(); }

 private:
    void writeState(const ScanResult& result);
    void writeTiming(const ScanResult& result);

    std::string folder_;
    TumWriter tum_;
    std::ofstream kitti_, states_, timing_;
    std::optional<PointTruthWriter> points_;
    std::optional<Pose> last_;
    ThinnedSample<Pose> sample_;
    int poses_ = 0;
    double length_ = 0;
};
}  // namespace taut
