#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <vector>

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
    /** `refined`: a pose is written as the scan after it left it, one scan late. `points`:
     * undistorted.points is written too, of the results' undistorted points. */
    ResultFiles(const std::string& folder, bool refined, bool points);

    void add(const ScanResult& result);
    void close();

    int poses() const { return poses_; }
    double length() const { return length_; }  //!< [m]
    /** Poses for pictures: thinned where the trajectory is long. */
    const std::vector<Pose>& sample() const { return sample_; }

 private:
    void writePose(Time t, const Pose& pose);
    void writeState(const ScanResult& result);
    void writeTiming(const ScanResult& result);

    std::string folder_;
    bool refined_;
    TumWriter tum_;
    std::ofstream kitti_, states_, timing_;
    std::optional<PointTruthWriter> points_;
    std::optional<StampedPose> pending_;
    std::optional<Pose> last_;
    std::vector<Pose> sample_;
    std::size_t sample_stride_ = 1;
    int poses_ = 0;
    double length_ = 0;
};
}  // namespace taut
