#include "taut/session/ResultFiles.h"

#include "taut/core/writeError.h"

namespace taut
{
namespace
{
constexpr std::size_t kMaxSample = 100'000;

std::ofstream open(const std::string& path)
{
    std::ofstream file(path);
    if (!file) throw writeError(path);
    file.precision(9);
    return file;
}

void close(std::ofstream& file, const std::string& name)
{
    flushOrThrow(file, name);
    file.close();
}

std::ostream& operator<<(std::ostream& out, const Vector3d& v)
{
    return out << v.x() << ',' << v.y() << ',' << v.z();
}
}  // namespace

PathFiles::PathFiles(const std::string& folder, const std::string& suffix)
    : tum_path_(folder + "/trajectory.tum" + suffix),
      kitti_path_(folder + "/trajectory_kitti.txt" + suffix),
      tum_(tum_path_),
      kitti_(open(kitti_path_)),
      sample_(kMaxSample)
{
}

void PathFiles::add(const StampedPose& stamped)
{
    const Pose& pose = stamped.T_world_imu;
    tum_.write(stamped);
    kitti_ << kittiLine(pose) << '\n';
    flushOrThrow(kitti_, kitti_path_);
    if (last_) length_ += (pose.p - last_->p).norm();
    last_ = pose;
    sample_.add(pose);
    poses_++;
}

void PathFiles::close()
{
    tum_.close();
    taut::close(kitti_, kitti_path_);
}

ResultFiles::ResultFiles(const std::string& folder, bool points)
    : folder_(folder), states_(open(folder + "/states.csv")), timing_(open(folder + "/timing.csv"))
{
    if (points) points_.emplace(folder + "/undistorted.points");
    states_ << "t,vx,vy,vz,ba_x,ba_y,ba_z,bg_x,bg_y,bg_z";
    for (const char* entry : {"p", "v", "theta", "ba", "bg"})
        for (const char* axis : {"x", "y", "z"}) states_ << ",var_" << entry << '_' << axis;
    states_ << ",iterations,features,correspondences,cost,balance,converged,lidar_used,"
               "translation_information_1,translation_information_2,translation_information_3,"
               "rotation_information_1,rotation_information_2,rotation_information_3,fit\n";
    timing_ << "t,points,transform_ms,preintegrate_ms,extract_ms,match_ms,solve_ms,insert_ms,"
               "total_ms\n";
}

void ResultFiles::add(const ScanResult& result)
{
    writeState(result);
    flushOrThrow(states_, folder_ + "/states.csv");
    writeTiming(result);
    flushOrThrow(timing_, folder_ + "/timing.csv");
    if (points_) points_->write({result.estimate.state.t, result.undistorted});
}

void ResultFiles::writeState(const ScanResult& r)
{
    const NavState& x = r.estimate.state;
    states_ << formatSeconds(x.t) << ',' << x.v_world << ',' << x.bias_accel << ',' << x.bias_gyro;
    for (int i = 0; i < NavState::kSize; i++) states_ << ',' << r.estimate.covariance(i, i);
    states_ << ',' << r.report.iterations << ',' << r.report.features << ','
            << r.report.correspondences << ',' << r.report.cost << ',' << r.report.balance << ','
            << r.report.converged << ',' << r.report.lidar_used;
    for (const double e : r.report.translation_information) states_ << ',' << e;
    for (const double e : r.report.rotation_information) states_ << ',' << e;
    states_ << ',' << r.report.fit() << '\n';
}

void ResultFiles::writeTiming(const ScanResult& r)
{
    const StageTimes& t = r.report.times;
    timing_ << formatSeconds(r.estimate.state.t) << ',' << r.report.scan_points << ','
            << t.transform << ',' << t.preintegrate << ',' << t.extract << ',' << t.match << ','
            << t.solve << ',' << t.insert << ',' << t.total() << '\n';
}

void ResultFiles::close()
{
    if (points_) points_->close();
    taut::close(states_, folder_ + "/states.csv");
    taut::close(timing_, folder_ + "/timing.csv");
}
}  // namespace taut
