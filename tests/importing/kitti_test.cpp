#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iomanip>

#include "kitti_support.h"
#include "reference.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
using testing::Contains;
using testing::HasSubstr;
namespace fs = std::filesystem;

/** The scanner of KITTI begins its turn at its back. Exactly there, begin and end are the same to
 * an azimuth: without those points. */
Reference atTheBack()
{
    Reference reference(3, 180);
    auto& points = reference.points;
    const auto ambiguous = [](const TimedPoint& p)
    { return std::abs(std::atan2(p.position.y(), p.position.x())) > M_PI - 1e-3; };
    points.erase(std::remove_if(points.begin(), points.end(), ambiguous), points.end());
    return reference;
}

const Reference& reference()
{
    static const Reference reference = atTheBack();
    return reference;
}

void writeOxts(const fs::path& folder, const ImuSamples& samples, const Vector3d& axes)
{
    fs::create_directories(folder / "data");
    std::ofstream times(folder / "timestamps.txt");
    for (std::size_t i = 0; i < samples.size(); i++)
    {
        times << dateText(samples[i].t) << "\n";
        std::ofstream file(folder / "data" / frameName(i, ".txt"));
        file << std::setprecision(17);
        for (int k = 0; k < 11; k++) file << "49.0 ";
        for (int k = 0; k < 3; k++) file << samples[i].accel[k] * axes[k] << " ";
        file << "0 0 0 ";
        for (int k = 0; k < 3; k++) file << samples[i].gyro[k] * axes[k] << " ";
        file << "0 0 0 0 0 0 4 5 6 6\n";
    }
}

class AKittiFolder : public testing::Test
{
 protected:
    static constexpr const char* kDrive = "2011_09_26/2011_09_26_drive_0001_sync";
    static constexpr const char* kDrive360 = "data_3d_raw/2013_05_28_drive_0000_sync";

    fs::path root() const { return folder_ / "kitti"; }
    std::string path(const std::string& name) const { return (root() / name).string(); }

    void writeScans(const std::string& folder) const
    {
        fs::create_directories(path(folder));
        for (int k = 0; k < 3; k++)
            writeBin(path(folder + "/" + frameName(k, ".bin")), reference().turn(k));
    }

    void writeStamps(const std::string& name, Duration shift) const
    {
        std::ofstream file(path(name));
        for (int k = 0; k < 3; k++)
            file << dateText(kStart + k * 100 * kMillisecond + shift) << "\n";
    }

    void writeRaw() const
    {
        const std::string points = std::string(kDrive) + "/velodyne_points";
        writeScans(points + "/data");
        writeStamps(points + "/timestamps_start.txt", 0);
        writeStamps(points + "/timestamps.txt", 50 * kMillisecond);
        writeStamps(points + "/timestamps_end.txt", 100 * kMillisecond);
        std::ofstream(path("2011_09_26/calib_imu_to_velo.txt"))
            << "calib_time: 25-May-2012 16:47:16\nR: 0 -1 0 1 0 0 0 0 1\nT: -0.8 0.3 -0.7\n";
        writeOxts(
            path("2011_09_26/2011_09_26_drive_0001_extract/oxts"), reference().imu, {1, 1, 1});
    }

    void write360(const Vector3d& axes) const
    {
        const std::string points = std::string(kDrive360) + "/velodyne_points";
        writeScans(points + "/data");
        writeStamps(points + "/timestamps.txt", 50 * kMillisecond);
        fs::create_directories(path("calibration"));
        std::ofstream(path("calibration/calib_cam_to_pose.txt"))
            << "image_00: 0 0 1 1.5 1 0 0 0 0 1 0 -0.9\nimage_01: 1 0 0 0 0 1 0 0 0 0 1 0\n";
        std::ofstream(path("calibration/calib_cam_to_velo.txt"))
            << "0 0 1 0.8 -1 0 0 0.1 0 -1 0 -0.2\n";
        writeOxts(path("data_poses/2013_05_28_drive_0000_sync/oxts"), reference().imu, axes);
    }

    const TemporaryFolder folder_;
};

TEST_F(AKittiFolder, OfRawDataGivesTheSamePointsAndTimes)
{
    writeRaw();
    const ReadBack back = importAndRead(path(kDrive), folder_ / "a.rawlog");
    EXPECT_EQ(back.scans.size(), 3U);
    expectSame(reference().points, back.points, {1e-6, 150, false});
    expectSame(reference().imu, back.imu);
    EXPECT_TRUE(back.warnings.counts().empty());
    const Pose& T = back.scans[0].T_imu_lidar;
    const Pose T_lidar_imu{expSO3({0, 0, M_PI / 2}), {-0.8, 0.3, -0.7}};
    EXPECT_LT((T.R - T_lidar_imu.inverse().R).norm(), 1e-9);
    EXPECT_LT((T.p - T_lidar_imu.inverse().p).norm(), 1e-9);
    EXPECT_THAT(back.findings, Contains(HasSubstr("_extract/oxts")));
}

TEST_F(AKittiFolder, Of360GivesTheSamePointsAndTimesWhicheverWayItsAxesPoint)
{
    for (const bool down : {false, true})
    {
        write360(down ? Vector3d(1, -1, -1) : Vector3d(1, 1, 1));
        const ReadBack back = importAndRead(path(kDrive360), folder_ / "a.rawlog");
        EXPECT_EQ(back.scans.size(), 3U);
        expectSame(reference().points, back.points, {1e-6, 150, false});
        // Forward, right, down.
        ImuSamples expected = reference().imu;
        for (ImuSample& s : expected)
        {
            s.gyro = s.gyro.cwiseProduct(Vector3d(1, -1, -1));
            s.accel = s.accel.cwiseProduct(Vector3d(1, -1, -1));
        }
        expectSame(expected, back.imu);
        const Pose& T = back.scans[0].T_imu_lidar;
        EXPECT_LT((T.R - Matrix3d(Vector3d(1, -1, -1).asDiagonal())).norm(), 1e-9);
        EXPECT_LT((T.p - Vector3d(0.7, 0.1, -1.1)).norm(), 1e-9);
        EXPECT_EQ(testing::Value(back.findings, Contains(HasSubstr("turned over"))), !down);
    }
}

TEST_F(AKittiFolder, OfTheOdometryBenchmarkIsMarkedAsUndistorted)
{
    writeScans("sequences/07/velodyne");
    std::ofstream(path("sequences/07/times.txt")) << "0.000000e+00\n1.037359e-01\n2.073459e-01\n";
    const ReadBack back = importAndRead(path("sequences/07"), folder_ / "a.rawlog");
    ASSERT_EQ(back.scans.size(), 3U);
    for (const Scan& scan : back.scans) EXPECT_TRUE(scan.already_undistorted);
    EXPECT_EQ(back.scans[0].stamp, 0);
    EXPECT_EQ(back.scans[1].stamp, 103'735'900);
    EXPECT_EQ(back.points.size(), reference().points.size());
    EXPECT_TRUE(back.warnings.counts().empty());
}

TEST_F(AKittiFolder, WithMissingFilesSaysWhich)
{
    writeRaw();
    fs::remove(path("2011_09_26/calib_imu_to_velo.txt"));
    fs::remove_all(path("2011_09_26/2011_09_26_drive_0001_extract"));
    const std::string points = std::string(kDrive) + "/velodyne_points/";
    fs::resize_file(path(points + "data/0000000001.bin"), 1001);
    std::ofstream(path(points + "data/0000000007.bin")) << "1234567890123456";
    const Imported all = importAll(path(kDrive));
    EXPECT_EQ(all.failure, "");
    EXPECT_EQ(all.scans.size(), 2U);
    EXPECT_EQ(all.warnings.count("scan_invalid"), 2U);
    EXPECT_EQ(all.warnings.count("no_calibration"), 1U);
    EXPECT_EQ(all.warnings.count("no_imu"), 1U);

    // The last three overflowed, or were other times.
    for (const char* text :
         {"2011-09-26 13:02:2x", "2011-2000000000-26 13:02:25", "2011-09-26 13:2000000000:25",
          "2011-09-26 13:02:9000000000"})
    {
        std::ofstream(path(points + "timestamps_end.txt")) << text << "\n";
        EXPECT_THAT(importAll(path(kDrive)).failure, HasSubstr("timestamps_end.txt:1:")) << text;
    }
    fs::remove(path(points + "timestamps_end.txt"));
    EXPECT_THAT(importAll(path(kDrive)).failure, HasSubstr("timestamps_end.txt"));
}
}  // namespace
}  // namespace taut::test
