#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "taut/core/TimeText.h"
#include "taut/core/Warning.h"
#include "taut/trajectory/Trajectory.h"

/** \file TrajectoryFile.h
 * Text files of trajectories, in the conventions of the evo project:
 * - TUM: `t x y z qx qy qz qw` a line, t in seconds, `#` starts a comment line;
 * - KITTI: the upper 3x4 part of T_world_body, 12 numbers row by row a line, no stamps.
 * Readers throw std::runtime_error naming file and line for anything malformed, not finite, not a
 * rotation, or going backward in time. */
namespace taut
{
/** One line of a TUM file, without its end: position to 1e-9 m, quaternion to 1e-12 with qw >= 0.
 */
std::string tumLine(const StampedPose& pose);

/** Reads a whole TUM file. A repeated stamp is dropped, with a warning (kind "repeated_stamp"): the
 * first pose counts. A malformed last line without an end is left out, with a warning ("cut_line"):
 * the program that wrote it was killed. */
Trajectory readTum(const std::string& path, const WarningSink& warn = {});

/** Reads a trajectory as the EuRoC data sets have their truth
 * (state_groundtruth_estimate0/data.csv): `t [ns], x, y, z [m], qw, qx, qy, qz`, and columns that
 * are left alone. Throws and warns as readTum(). */
Trajectory readEuroc(const std::string& path, const WarningSink& warn = {});

/** Writes a TUM file pose by pose, so that a long run needs no memory for it; each pose is in the
 * file when write() returns, whatever becomes of the program. Throws
 * std::runtime_error if the file cannot be written, std::invalid_argument if time does not
 * increase. */
class TumWriter
{
 public:
    explicit TumWriter(const std::string& path);
    void write(const StampedPose& pose);
    void close();

 private:
    std::string path_;
    std::ofstream file_;
    bool any_ = false;
    Time last_ = 0;
};

void writeTum(const std::string& path, const Trajectory& trajectory);

/** Poses T_world_body of a KITTI file. */
std::vector<Pose> readKitti(const std::string& path);

/** The same with their stamps, from a file of as many times in seconds, one a line ("times.txt").
 */
Trajectory readKitti(const std::string& path, const std::string& times_path);

/** One line of a KITTI file, without its end: numbers with 12 decimals. */
std::string kittiLine(const Pose& pose);
void writeKitti(const std::string& path, const std::vector<Pose>& poses);
}  // namespace taut
