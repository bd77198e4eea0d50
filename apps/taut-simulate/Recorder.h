#pragma once

#include <fstream>
#include <optional>
#include <string>

#include "taut/rawlog/RawlogWriter.h"
#include "taut/simulation/Simulator.h"
#include "taut/trajectory/PointTruth.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace taut
{
/** What to write of a simulation. */
struct RecorderConfig
{
    std::string rawlog;    //!< its path; the truth is written beside it
    bool points = false;   //!< the truth of every point as well
    bool packets = false;  //!< the LiDAR as raw packets: VLP-16 and HDL-32E
    bool mesh = false;     //!< the surface of what is at rest in the world as well
};

/** The files of a recording. */
struct RecordedFiles
{
    std::string rawlog, truth, biases, points, mesh;
};

/** The comment in OUT.mesh.ply. */
inline const char* const kMeshComment = "taut-simulate: the world at rest";

/** OUT.rawlog, OUT.gt.tum, OUT.biases.csv, OUT.points, OUT.mesh.ply. */
RecordedFiles recordedFiles(const std::string& rawlog);

/** Writes a simulation with its faults to files: OUT.rawlog, OUT.gt.tum (pose of the IMU in the
 * world at the true time of every sample), OUT.biases.csv, OUT.points, OUT.mesh.ply (in the world
 * frame of the truth, without what moves). They get their names when they are whole (close()), the
 * rawlog last. Throws std::runtime_error naming the file that cannot
 * be written. */
class Recorder
{
 public:
    /** Throws ConfigError if the LiDAR has no packets that could be written. Keeps a reference. */
    Recorder(
        const RecorderConfig& config, const simulation::Scenario& scenario,
        const simulation::Simulator& simulator);

    /** Writes sweep k = 0, 1, ... and the IMU samples that came before its end. */
    void add(int k, simulation::SimulatedScan scan);

    /** Writes the rest and completes the files. */
    void close();

    std::size_t points() const { return points_; }
    std::size_t samples() const { return samples_; }

 private:
    void writeImuUntil(Time end);
    void writePackets(simulation::SimulatedScan& scan, double azimuth, Duration clock);
    void writeTruth() const;
    void writeWorld() const;

    RecorderConfig config_;
    RecordedFiles files_;
    simulation::Scenario scenario_;
    const simulation::Simulator& simulator_;
    simulation::Faults faults_;
    Time start_;
    RawlogWriter rawlog_;
    std::optional<PointTruthWriter> point_truth_;
    Time last_scan_end_ = 0;
    std::size_t next_sample_ = 0, points_ = 0, samples_ = 0;
};
}  // namespace taut
