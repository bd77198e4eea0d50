#include "Recorder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "VelodynePackets.h"
#include "taut/files/MeshFile.h"

namespace taut
{
using namespace simulation;

namespace
{
std::string besides(const std::string& rawlog, const std::string& ending)
{
    const std::string own = ".rawlog";
    const bool has_own = rawlog.size() > own.size() &&
                         rawlog.compare(rawlog.size() - own.size(), own.size(), own) == 0;
    return rawlog.substr(0, rawlog.size() - (has_own ? own.size() : 0)) + ending;
}

std::string part(const std::string& file)
{
    return file + ".part";
}

/** A reader drops points that are not finite: they have no truth. */
void dropNotFinite(std::vector<Eigen::Vector3f>& positions)
{
    positions.erase(
        std::remove_if(
            positions.begin(), positions.end(),
            [](const Eigen::Vector3f& p) { return !p.allFinite(); }),
        positions.end());
}

velodyne::Model modelOf(const LidarConfig& config)
{
    if (config.type == LidarType::Vlp16) return velodyne::Model::Vlp16;
    if (config.type == LidarType::Hdl32) return velodyne::Model::Hdl32;
    throw ConfigError("only a VLP-16 and an HDL-32E can be written as packets");
}
}  // namespace

RecordedFiles recordedFiles(const std::string& rawlog)
{
    return {
        rawlog, besides(rawlog, ".gt.tum"), besides(rawlog, ".biases.csv"),
        besides(rawlog, ".points"), besides(rawlog, ".mesh.ply")};
}

Recorder::Recorder(
    const RecorderConfig& config, const Scenario& scenario, const Simulator& simulator)
    : config_(config),
      files_(recordedFiles(config.rawlog)),
      scenario_(scenario),
      simulator_(simulator),
      faults_(scenario.faults, static_cast<std::uint64_t>(scenario.seed)),
      start_(static_cast<Time>(scenario.start_time) * 1'000'000'000),
      rawlog_(config.rawlog)
{
    if (config.packets) modelOf(scenario.lidar);
    if (config.points) point_truth_.emplace(part(files_.points));
}

void Recorder::add(int k, SimulatedScan simulated)
{
    Scan& scan = simulated.scan;
    writeImuUntil(scan.end);  // in the order of arrival: a scan is there when it has ended
    const Time true_stamp = scan.stamp;
    const double azimuth =
        360 * std::fmod(toSeconds(true_stamp - Lidar::kStart) * scenario_.lidar.rotation_rate, 1);
    if (!faults_.spoil(simulated, static_cast<std::uint64_t>(k))) return;
    scan.stamp += start_;
    scan.end += start_;
    if (config_.packets)
        writePackets(simulated, azimuth, scan.stamp - true_stamp);
    else
        rawlog_.write(scan);
    points_ += scan.points.size();
    // Readers drop scans that go back in time: they have no truth.
    if (!point_truth_ || scan.end <= last_scan_end_) return;
    last_scan_end_ = scan.end;
    dropNotFinite(simulated.truth);
    point_truth_->write({scan.end, simulated.truth});
}

void Recorder::writePackets(SimulatedScan& simulated, double azimuth, Duration clock)
{
    PacketScan packets;
    packets.stamp = simulated.scan.stamp;
    packets.T_imu_lidar = simulated.scan.T_imu_lidar;
    packets.packets =
        packetsOf(simulated.scan, modelOf(scenario_.lidar), azimuth, scenario_.lidar.rotation_rate);
    rawlog_.write(packets);
    // The truth is that of the points as the packets hold them.
    simulated.scan = decoded(packets);
    const Scan ideal = simulator_.lidar().withoutErrors(simulated.scan, clock);
    simulated.truth = undistorted(ideal, simulator_.motion(), clock);
}

void Recorder::writeImuUntil(Time end)
{
    const ImuRecording& imu = simulator_.imu();
    for (; next_sample_ < imu.samples.size() && imu.times[next_sample_] < end; next_sample_++)
    {
        ImuSample sample = imu.samples[next_sample_];
        if (!faults_.spoil(sample, next_sample_)) continue;
        sample.t += start_;
        rawlog_.write(sample);
        samples_++;
    }
}

void Recorder::writeTruth() const
{
    TumWriter tum(part(files_.truth));
    const std::string biases_path = part(files_.biases);
    std::ofstream biases(biases_path);
    biases << "t,bias_gyro_x,bias_gyro_y,bias_gyro_z,bias_accel_x,bias_accel_y,bias_accel_z\n";
    biases.precision(9);
    const ImuRecording& imu = simulator_.imu();
    Time last = 0;
    for (std::size_t i = 0; i < imu.times.size(); i++)
    {
        const Time t = start_ + faults_.clock(imu.times[i]);
        if (t <= last) continue;  // after the clocks were put back
        last = t;
        tum.write({t, simulator_.motion().poseAt(toSeconds(imu.times[i]))});
        biases << formatSeconds(t);
        for (const Vector3d& bias : {imu.gyro_bias[i], imu.accel_bias[i]})
            for (int axis = 0; axis < 3; axis++) biases << "," << bias[axis];
        biases << "\n";
    }
    tum.close();
    biases.close();
    if (!biases) throw std::runtime_error("cannot write '" + biases_path + "'");
}

void Recorder::writeWorld() const
{
    const Mesh& world = simulator_.scene().world.mesh();
    writeMesh(part(files_.mesh), {world.vertices, world.triangles}, kMeshComment);
}

void Recorder::close()
{
    writeImuUntil(std::numeric_limits<Time>::max());
    if (point_truth_) point_truth_->close();
    writeTruth();
    if (config_.mesh) writeWorld();
    for (const std::string& file : {files_.truth, files_.biases})
        std::filesystem::rename(part(file), file);
    if (point_truth_) std::filesystem::rename(part(files_.points), files_.points);
    if (config_.mesh) std::filesystem::rename(part(files_.mesh), files_.mesh);
    rawlog_.close();
}
}  // namespace taut
