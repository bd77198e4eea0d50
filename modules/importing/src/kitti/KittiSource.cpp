#include "KittiSource.h"

#include <cmath>
#include <stdexcept>

#include "../MergedSource.h"
#include "../filesIn.h"
#include "KittiFiles.h"

namespace taut
{
namespace fs = std::filesystem;
using namespace kitti;

namespace
{
constexpr const char* kFromAzimuth =
    "times of the points: from their azimuth, clockwise from the back";

/** Begin and end of each sweep, by its number; nothing where it is not known. */
using Sweeps = std::vector<std::optional<std::pair<Time, Time>>>;

bool hasPoints(const Recording& recording)
{
    return recording.is_folder && fs::is_directory(recording.path / "velodyne_points/data");
}

/** The scans of a folder, a time for each point. */
SensorStreams sweepStreams(
    const fs::path& drive, Sweeps sweeps, const Pose& T_imu_lidar, const WarningSink& warn)
{
    auto files = std::make_shared<FileQueue>(filesIn(drive / "velodyne_points/data"));
    SensorStreams streams;
    streams.progress = [files] { return files->progress(); };
    const auto read = [sweeps = std::move(sweeps), T_imu_lidar](const fs::path& file)
    {
        const auto frame = frameOf(file);
        if (!frame || *frame >= sweeps.size() || !sweeps[*frame])
            throw std::runtime_error("'" + file.string() + "' has no time stamp");
        const auto [begin, end] = *sweeps[*frame];
        const auto duration = static_cast<double>(end - begin);
        Scan scan = readPoints(
            file, begin,
            [duration](double x, double y) { return std::llround(shareOfSweep(x, y) * duration); });
        scan.end = end;
        scan.T_imu_lidar = T_imu_lidar;
        return scan;
    };
    streams.next_scan = [files, read, warn] { return files->nextScan(read, warn); };
    streams.findings = {std::to_string(files->size()) + " scans", kFromAzimuth};
    return streams;
}

void addImu(SensorStreams& streams, const fs::path& oxts, const WarningSink& warn)
{
    if (!fs::exists(oxts / "timestamps.txt"))
    {
        streams.next_sample = [] { return std::optional<ImuSample>(); };  // that it lacks is told
        return;
    }
    auto reader = std::make_shared<OxtsReader>(oxts, warn);
    streams.findings.push_back(
        "IMU: " + std::to_string(reader->size()) + " samples of '" + oxts.string() + "'");
    streams.next_sample = [reader] { return reader->next(); };
}

/** 12 numbers, row by row, of an entry. */
Pose poseOf(const std::vector<double>& values, const fs::path& file)
{
    if (values.size() != 12)
        throw std::runtime_error("'" + file.string() + "' has no 3 x 4 matrix where it should");
    Pose pose;
    for (int row = 0; row < 3; row++)
    {
        for (int column = 0; column < 3; column++) pose.R(row, column) = values[4 * row + column];
        pose.p[row] = values[4 * row + 3];
    }
    pose.R = normalizedRotation(pose.R);
    return pose;
}

/** What `read` gives, or a warning and the identity where a file is missing. */
template <class Read>
Pose calibrated(const std::vector<fs::path>& files, Read read, const WarningSink& warn)
{
    for (const fs::path& file : files)
    {
        if (fs::exists(file)) continue;
        if (warn)
            warn(
                {0, "no_calibration",
                 "'" + file.string() +
                     "' is not there: the LiDAR is taken to be where the IMU is, unless a rig file "
                     "tells better"});
        return {};
    }
    return read();
}

Pose rawCalibration(const fs::path& date, const WarningSink& warn)
{
    const fs::path file = date / "calib_imu_to_velo.txt";
    return calibrated(
        {file},
        [&]
        {
            auto entries = readCalibration(file);
            auto &R = entries["R"], &T = entries["T"];
            if (R.size() != 9 || T.size() != 3)
                throw std::runtime_error("'" + file.string() + "' has no R and T");
            return poseOf(
                       {R[0], R[1], R[2], T[0], R[3], R[4], R[5], T[1], R[6], R[7], R[8], T[2]},
                       file)
                .inverse();  // it maps points of the IMU to the LiDAR
        },
        warn);
}

Pose calibrationOf360(const fs::path& root, const WarningSink& warn)
{
    const fs::path to_pose = root / "calibration/calib_cam_to_pose.txt";
    const fs::path to_velo = root / "calibration/calib_cam_to_velo.txt";
    return calibrated(
        {to_pose, to_velo},
        [&]
        {
            const Pose T_imu_camera = poseOf(readCalibration(to_pose)["image_00"], to_pose);
            const Pose T_lidar_camera = poseOf(readCalibration(to_velo)[""], to_velo);
            return T_imu_camera * T_lidar_camera.inverse();
        },
        warn);
}

/** Sweeps around the times when the scanner faced forward, of the median period. */
Sweeps around(const std::vector<std::optional<Time>>& forward)
{
    std::vector<Duration> periods;
    for (std::size_t i = 1; i < forward.size(); i++)
        if (forward[i] && forward[i - 1]) periods.push_back(*forward[i] - *forward[i - 1]);
    if (periods.empty()) throw std::runtime_error("there are no two times of scans");
    const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
    std::nth_element(periods.begin(), middle, periods.end());
    const Duration half = *middle / 2;
    Sweeps sweeps;
    for (const auto& t : forward)
        sweeps.push_back(
            t ? std::make_optional(std::make_pair(*t - half, *t + half)) : std::nullopt);
    return sweeps;
}

/** The unsynchronised drive has the IMU at 100 Hz, the synchronised one at the rate of the scans.
 */
fs::path oxtsOf(const fs::path& drive)
{
    const std::string name = drive.filename().string(), sync = "_sync";
    if (name.size() > sync.size() && name.substr(name.size() - sync.size()) == sync)
    {
        const fs::path extract =
            drive.parent_path() / (name.substr(0, name.size() - sync.size()) + "_extract");
        if (fs::exists(extract / "oxts/timestamps.txt")) return extract / "oxts";
    }
    return drive / "oxts";
}

/** The calibration of KITTI-360 has the IMU's axes forward, right, down. If the forces are given
 * forward, left, up, gravity tells: the car is not on its roof. */
bool isUpsideDown(const fs::path& oxts, const Pose& T_imu_lidar)
{
    if (!fs::exists(oxts / "timestamps.txt")) return false;
    OxtsReader reader(oxts, {});
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < 100; i++)
        if (const auto sample = reader.next()) sum += sample->accel;
    return (T_imu_lidar.R.transpose() * sum).z() < 0;
}

void turnOver(SensorStreams& streams)
{
    streams.findings.emplace_back(
        "IMU: its axes are forward, left, up, those of the calibration forward, right, down (by "
        "gravity): turned over");
    streams.next_sample = [next = streams.next_sample]
    {
        auto sample = next();
        if (!sample) return sample;
        const Vector3d over(1, -1, -1);
        sample->accel = sample->accel.cwiseProduct(over);
        sample->gyro = sample->gyro.cwiseProduct(over);
        return sample;
    };
}

/** Without the "." or "/" at the end that would hide the name of a folder. */
fs::path withoutTrail(const fs::path& path)
{
    return fs::canonical(path);
}
}  // namespace

bool isKittiRaw(const Recording& recording)
{
    return hasPoints(recording) &&
           fs::exists(recording.path / "velodyne_points/timestamps_start.txt");
}

std::unique_ptr<ImportSource> openKittiRaw(
    const Recording& recording, const ImportOptions&, const WarningSink& warn)
{
    const fs::path drive = withoutTrail(recording.path);
    const auto begins = readTimestamps(drive / "velodyne_points/timestamps_start.txt");
    const auto ends = readTimestamps(drive / "velodyne_points/timestamps_end.txt");
    Sweeps sweeps(std::min(begins.size(), ends.size()));
    for (std::size_t i = 0; i < sweeps.size(); i++)
        if (begins[i] && ends[i] && *ends[i] > *begins[i]) sweeps[i] = {*begins[i], *ends[i]};
    SensorStreams streams =
        sweepStreams(drive, sweeps, rawCalibration(drive.parent_path(), warn), warn);
    addImu(streams, oxtsOf(drive), warn);
    return std::make_unique<MergedSource>(drive.string(), std::move(streams), warn);
}

bool isKitti360(const Recording& recording)
{
    return hasPoints(recording) && fs::exists(recording.path / "velodyne_points/timestamps.txt");
}

std::unique_ptr<ImportSource> openKitti360(
    const Recording& recording, const ImportOptions&, const WarningSink& warn)
{
    const fs::path drive = withoutTrail(recording.path);
    const fs::path root = drive.parent_path().parent_path();
    const Pose calibration = calibrationOf360(root, warn);
    SensorStreams streams = sweepStreams(
        drive, around(readTimestamps(drive / "velodyne_points/timestamps.txt")), calibration, warn);
    streams.findings.emplace_back("stamps of the scans: taken as when the scanner faced forward");
    const fs::path oxts = root / "data_poses" / drive.filename() / "oxts";
    addImu(streams, oxts, warn);
    if (isUpsideDown(oxts, calibration)) turnOver(streams);
    return std::make_unique<MergedSource>(drive.string(), std::move(streams), warn);
}

bool isKittiOdometry(const Recording& recording)
{
    return recording.is_folder && fs::is_directory(recording.path / "velodyne") &&
           fs::exists(recording.path / "times.txt");
}

std::unique_ptr<ImportSource> openKittiOdometry(
    const Recording& recording, const ImportOptions&, const WarningSink& warn)
{
    auto files = std::make_shared<FileQueue>(filesIn(recording.path / "velodyne"));
    SensorStreams streams;
    streams.progress = [files] { return files->progress(); };
    const auto read = [times = readTimes(recording.path / "times.txt")](const fs::path& file)
    {
        const auto frame = frameOf(file);
        if (!frame || *frame >= times.size())
            throw std::runtime_error("'" + file.string() + "' has no time in times.txt");
        return readPoints(file, times[*frame], [](double, double) { return Duration{0}; });
    };
    streams.next_scan = [files, read, warn] { return files->nextScan(read, warn); };
    streams.undistorted = true;
    streams.findings = {
        std::to_string(files->size()) + " scans",
        "the benchmark has no IMU, and its scans are "
        "undistorted"};
    return std::make_unique<MergedSource>(recording.path.string(), std::move(streams), warn);
}
}  // namespace taut
