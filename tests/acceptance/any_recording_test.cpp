/** One simulated drive in the formats of several recorders, each through taut-slam. */
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <optional>

#include "OusterSimulator.h"
#include "PcapWriter.h"
#include "bag_writers.h"
#include "kitti_support.h"
#include "recording.h"
#include "slam_program.h"
#include "taut/rawlog/RawlogWriter.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;
using testing::HasSubstr;
namespace fs = std::filesystem;

Recording shortDrive()
{
    Recording drive;
    drive.rest = 1;
    drive.duration = 5;
    drive.range_noise = 0;
    return drive;
}

/** A sweep of a scanner that begins at its back and turns clockwise, as that of KITTI does; the
 * times are whole ticks of a rawlog. */
Scan sweepFromTheBack(const Recording& drive, Time begin)
{
    constexpr int kColumns = 400, kRings = 16;
    constexpr Duration kStep = 250'000;
    Scan scan;
    scan.stamp = begin + kStep / 2;
    scan.rings = kRings;
    scan.T_imu_lidar = drive.T_imu_lidar;
    for (int column = 0; column < kColumns; column++)
    {
        LidarPoint point;
        point.offset = static_cast<std::int32_t>(kStep * column);
        const Pose sensor =
            drive.pose(toSeconds(scan.timeOf(point) - drive.start)) * drive.T_imu_lidar;
        const Scene seen = Recording::room().seenFrom(sensor.p);
        const double azimuth = M_PI - 2 * M_PI * (column + 0.5) / kColumns;
        for (int ring = 0; ring < kRings; ring++)
        {
            const double elevation = (-25 + 3 * ring) * M_PI / 180;
            const Vector3d d(
                std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                std::sin(elevation));
            point.position = (seen.range(sensor.R * d) * d).cast<float>();
            point.ring = static_cast<std::uint16_t>(ring);
            point.intensity = static_cast<float>(ring);
            scan.points.push_back(point);
        }
    }
    scan.end = scan.stamp + kStep * (kColumns - 1);
    return scan;
}

/** What the sensors of a drive measured. */
struct Measured
{
    std::vector<Scan> scans;
    ImuSamples imu;
};

Measured measuredByKitti()
{
    const Recording drive = shortDrive();
    Measured m;
    for (int k = 0; k < 50; k++)
        m.scans.push_back(sweepFromTheBack(drive, drive.start + k * drive.scan_period));
    m.imu = drive.imu();
    return m;
}

void writeRawlog(const std::string& path, const Measured& m)
{
    RawlogWriter writer(path);
    auto sample = m.imu.begin();
    for (const Scan& scan : m.scans)
    {
        for (; sample != m.imu.end() && sample->t <= scan.end; ++sample) writer.write(*sample);
        writer.write(scan);
    }
    for (; sample != m.imu.end(); ++sample) writer.write(*sample);
    writer.close();
}

/** Frames of a bag: LiDAR and IMU are both told from a third. */
struct Mounted
{
    std::string base = "base_link", imu = "imu_link", lidar = "velodyne";
    Pose T_base_imu, T_base_lidar;
};

Mounted mountedAs(const Pose& T_imu_lidar)
{
    const Pose T_base_imu{expSO3({0, 0.1, -2}), {0.3, -0.4, 1}};
    return {"base_link", "imu_link", "velodyne", T_base_imu, T_base_imu * T_imu_lidar};
}

TestMessages bagOf(
    const Measured& m, const std::optional<Mounted>& mounted, TestWire wire,
    const std::vector<std::string>& lidar_topics = {"/points"})
{
    TestMessages messages;
    const Mounted frames = mounted.value_or(Mounted{});
    if (mounted)
        messages.push_back(
            {"/tf_static", "tf2_msgs/TFMessage", m.imu.front().t,
             transformsMessage(
                 {transformOf(frames.base, frames.imu, frames.T_base_imu),
                  transformOf(frames.base, frames.lidar, frames.T_base_lidar)},
                 wire)});
    CloudStyle style;
    style.frame = frames.lidar;
    for (const Scan& scan : m.scans)
        for (const std::string& topic : lidar_topics)
            messages.push_back(
                {topic, "sensor_msgs/PointCloud2", scan.end + 5'000'000,
                 CloudWriter(scan, style, wire).message()});
    for (const ImuSample& sample : m.imu)
        messages.push_back(
            {"/imu", "sensor_msgs/Imu", sample.t + 1'000'000,
             imuMessage(sample, wire, frames.imu)});
    std::stable_sort(
        messages.begin(), messages.end(),
        [](const TestMessage& a, const TestMessage& b) { return a.received < b.received; });
    return messages;
}

/** Gives the path of the drive. */
std::string writeKitti(const fs::path& root, const Measured& m)
{
    const fs::path date = root / "2011_09_26", drive = date / "2011_09_26_drive_0007_sync";
    const fs::path points = drive / "velodyne_points", oxts = drive / "oxts";
    fs::create_directories(points / "data");
    fs::create_directories(oxts / "data");
    std::ofstream begins(points / "timestamps_start.txt"), ends(points / "timestamps_end.txt");
    for (std::size_t k = 0; k < m.scans.size(); k++)
    {
        const Time begin = m.scans[k].stamp - 125'000;
        begins << dateText(begin) << "\n";
        ends << dateText(begin + 100'000'000) << "\n";
        writeBin((points / "data" / frameName(k, ".bin")).string(), m.scans[k]);
    }
    std::ofstream times(oxts / "timestamps.txt");
    for (std::size_t i = 0; i < m.imu.size(); i++)
    {
        times << dateText(m.imu[i].t) << "\n";
        std::ofstream file(oxts / "data" / frameName(i, ".txt"));
        file << std::setprecision(17);
        for (int k = 0; k < 11; k++) file << "49.0 ";
        for (int k = 0; k < 3; k++) file << m.imu[i].accel[k] << " ";
        file << "0 0 0 ";
        for (int k = 0; k < 3; k++) file << m.imu[i].gyro[k] << " ";
        file << "0 0 0 0 0 0 4 5 6 6\n";
    }
    const Pose T_lidar_imu = m.scans[0].T_imu_lidar.inverse();
    std::ofstream calibration(date / "calib_imu_to_velo.txt");
    calibration << std::setprecision(17) << "calib_time: 25-May-2012 16:47:16\nR:";
    for (int i = 0; i < 9; i++) calibration << " " << T_lidar_imu.R(i / 3, i % 3);
    calibration << "\nT:";
    for (int i = 0; i < 3; i++) calibration << " " << T_lidar_imu.p[i];
    calibration << "\n";
    return drive.string();
}

class ADrive : public testing::Test
{
 protected:
    /** Runs taut-slam on it; what it says is in `output_`. */
    Trajectory trajectoryOf(const std::string& recording)
    {
        const std::string out = folder_ / ("out" + std::to_string(runs_++));
        const ProgramRun run = slam(recording, out, "--no-report");
        EXPECT_EQ(run.exit_code, 0) << run.output;
        output_ = run.output;
        return run.exit_code == 0 ? readTum(out + "/trajectory.tum") : Trajectory();
    }

    static void expectSame(
        const Trajectory& expected, const Trajectory& got, double metres, double radians)
    {
        ASSERT_EQ(got.size(), expected.size());
        double farthest = 0, most_turned = 0;
        for (std::size_t i = 0; i < got.size(); i++)
        {
            EXPECT_LE(std::abs(got[i].t - expected[i].t), 1000) << i;
            const Pose d = expected[i].T_world_imu.inverse() * got[i].T_world_imu;
            farthest = std::max(farthest, d.p.norm());
            most_turned = std::max(most_turned, logSO3(d.R).norm());
        }
        EXPECT_LT(farthest, metres);
        EXPECT_LT(most_turned, radians);
    }

    /** That the trajectory is the drive's, so that equal ones are worth something. */
    static void expectTrue(const Trajectory& got, const Pose& T_imu_lidar)
    {
        Recording drive = shortDrive();
        drive.T_imu_lidar = T_imu_lidar;
        ASSERT_GT(got.size(), 40U);
        const Pose begin = drive.pose(toSeconds(got.front().t - drive.start)).inverse();
        for (const StampedPose& pose : got)
        {
            const Pose truth = begin * drive.pose(toSeconds(pose.t - drive.start));
            const Pose moved = got.front().T_world_imu.inverse() * pose.T_world_imu;
            EXPECT_LT((moved.p - truth.p).norm(), 0.02);
        }
    }

    const TemporaryFolder folder_;
    std::string output_;
    int runs_ = 0;
};

TEST_F(ADrive, HasTheSamePathFromABagAKittiFolderAndARawlog)
{
    const Measured m = measuredByKitti();
    const Pose T_imu_lidar = m.scans[0].T_imu_lidar;
    writeRawlog(folder_ / "a.rawlog", m);
    writeFile(
        folder_ / "a.bag",
        Ros1Writer::bag(bagOf(m, mountedAs(T_imu_lidar), TestWire::Ros1), {"lz4", 20, true}));
    const Trajectory expected = trajectoryOf(folder_ / "a.rawlog");
    expectTrue(expected, T_imu_lidar);
    expectSame(expected, trajectoryOf(folder_ / "a.bag"), 1e-6, 1e-6);
    EXPECT_THAT(output_, HasSubstr("(tf_static: imu_link <- base_link <- velodyne)"));
    expectSame(expected, trajectoryOf(writeKitti(folder_ / "kitti", m)), 1e-4, 1e-4);
}

TEST_F(ADrive, HasTheSamePathFromACaptureABagAndARawlog)
{
    OusterSimulator sensor;
    sensor.columns = 512;
    sensor.device_start = shortDrive().start;
    const Pose T_sensor_lidar{Vector3d(-1, -1, 1).asDiagonal(), {0, 0, 0.03618}};
    const Pose T_sensor_imu{Matrix3d::Identity(), {0.006253, -0.011775, 0.007645}};
    const Pose T_imu_lidar = T_sensor_imu.inverse() * T_sensor_lidar;
    const Recording drive = shortDrive();
    constexpr int kFrames = 50;
    std::vector<unsigned> ranges;
    for (int frame = 0; frame < kFrames; frame++)
        for (int column = 0; column < sensor.columns; column++)
        {
            const double s = toSeconds(sensor.columnTime(frame, column) - drive.start);
            const Pose lidar = drive.pose(s) * T_imu_lidar;
            const double encoder = 2 * M_PI * (1 - static_cast<double>(column) / sensor.columns);
            const Vector3d origin =
                OusterSimulator::kBeamOrigin * Vector3d(std::cos(encoder), std::sin(encoder), 0);
            const Scene seen = Recording::room().seenFrom(lidar * origin);
            for (int pixel = 0; pixel < sensor.pixels; pixel++)
            {
                const double a = encoder - sensor.azimuth(pixel), e = sensor.altitude(pixel);
                const Vector3d d(std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e));
                const double range = seen.range(lidar.R * d) + OusterSimulator::kBeamOrigin;
                ranges.push_back(static_cast<unsigned>(std::lround(1000 * range)));
            }
        }
    sensor.range_mm = [&](int frame, int column, int pixel)
    { return ranges[static_cast<std::size_t>((frame * 512 + column) * 16 + pixel)]; };

    Measured m;
    m.imu = drive.imu();
    std::optional<PcapWriter> pcap(std::in_place, folder_ / "a.pcap");
    std::ofstream(folder_ / "a.json") << sensor.description();
    auto sample = m.imu.begin();
    for (int frame = 0; frame < kFrames; frame++)
    {
        Scan scan;
        scan.stamp = sensor.columnTime(frame, 0);
        scan.rings = sensor.pixels;
        scan.T_imu_lidar = T_imu_lidar;
        for (int column = 0; column < sensor.columns; column++)
            for (int pixel = 0; pixel < sensor.pixels; pixel++)
            {
                LidarPoint point;
                point.position = sensor.point(frame, column, pixel).cast<float>();
                point.offset =
                    static_cast<std::int32_t>(sensor.columnTime(frame, column) - scan.stamp);
                point.ring = static_cast<std::uint16_t>(pixel);
                scan.points.push_back(point);
            }
        scan.end = sensor.columnTime(frame, sensor.columns - 1);
        m.scans.push_back(scan);
        for (int i = 0; i < sensor.packetsPerFrame(); i++)
        {
            const Time sent =
                sensor.columnTime(frame, (i + 1) * sensor.columns_per_packet - 1) + 100'000;
            for (; sample != m.imu.end() && sample->t < sent; ++sample)
                pcap->write(sample->t + 100'000, 7503, OusterSimulator::imuPacket(*sample));
            pcap->write(sent, 7502, sensor.packet(frame, i));
        }
    }
    pcap.reset();  // closes it
    writeRawlog(folder_ / "a.rawlog", m);
    const Mounted mounted{"os_sensor", "os_imu", "os_lidar", T_sensor_imu, T_sensor_lidar};
    writeFile(folder_ / "b.mcap", McapWriter::file(bagOf(m, mounted, TestWire::Cdr)));
    const Trajectory expected = trajectoryOf(folder_ / "a.rawlog");
    expectTrue(expected, T_imu_lidar);
    expectSame(expected, trajectoryOf(folder_ / "b.mcap"), 1e-6, 1e-6);
    expectSame(expected, trajectoryOf(folder_ / "a.pcap"), 1e-4, 1e-4);
}

TEST_F(ADrive, WhoseLidarIsTurnedAndDoesNotTellItIsWarnedOf)
{
    const Measured m = measuredByKitti();
    writeFile(folder_ / "a.mcap", McapWriter::file(bagOf(m, std::nullopt, TestWire::Cdr)));
    const ProgramRun run = slam(folder_ / "a.mcap", folder_ / "out", "--no-report");
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.output, HasSubstr("T_imu_lidar: not told"));
    EXPECT_THAT(run.output, HasSubstr("warning [extrinsic_rotation]"));
    EXPECT_THAT(run.output, HasSubstr("it is not the identity: the LiDAR is mounted 8"));
}

TEST_F(ADrive, OfTwoLidarsSaysTheCommandThatChoosesOne)
{
    Measured m = measuredByKitti();
    m.scans.resize(10);
    m.imu.resize(210);
    const Mounted mounted = mountedAs(m.scans[0].T_imu_lidar);
    const std::string bag = folder_ / "a drive.bag", out = folder_ / "out";
    writeFile(
        bag, Ros1Writer::bag(bagOf(m, mounted, TestWire::Ros1, {"/front/points", "/rear/points"})));
    const std::string command =
        std::string(TAUT_SLAM) + " '" + bag + "' -o " + out + " -q --no-pictures --no-report";
    for (const std::string given : {"", " --lidar-topic '/.*'"})
    {
        const ProgramRun run = runProgram(command + given, "");
        EXPECT_EQ(run.exit_code, 1);
        EXPECT_THAT(run.output, HasSubstr("/front/points (sensor_msgs/PointCloud2), /rear/points"));
        const std::string before = "; choose one, as in: ";
        const auto at = run.output.find(before);
        ASSERT_NE(at, std::string::npos) << run.output;
        const std::string advised = run.output.substr(at + before.size());
        EXPECT_EQ(advised, command + " --lidar-topic /front/points\n");
        const ProgramRun chosen = runProgram(advised.substr(0, advised.size() - 1) + " -w", "");
        EXPECT_EQ(chosen.exit_code, 0) << chosen.output;
    }
}
}  // namespace
