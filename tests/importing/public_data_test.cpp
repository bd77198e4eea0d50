/** The rig files of public data sets (config/rigs): that they say what their sources say, and that
 * recordings of the same topics and types are imported with them. */
#include <filesystem>
#include <map>
#include <optional>

#include "bag_support.h"
#include "taut/core/Yaml.h"
#include "taut/importing/Import.h"

namespace taut::test
{
namespace
{
using testing::Contains;
using testing::HasSubstr;

Rig rigOf(const std::string& name)
{
    return loadRig(TAUT_RIGS "/" + name + ".yaml");
}

/** A pose as a source gives it: translation and quaternion. */
Pose poseOf(const Vector3d& p, double qx, double qy, double qz, double qw)
{
    return {Eigen::Quaterniond(qw, qx, qy, qz).normalized().toRotationMatrix(), p};
}

/** T_imu_lidar of each set, in the form of its source; none where the recording has it. */
std::map<std::string, std::optional<Pose>> publishedPoses()
{
    const Pose T_sensor_imu = poseOf({0.006253, -0.011775, 0.007645}, 0, 0, 0, 1);
    const Pose T_sensor_lidar = poseOf({0, 0, 0.03618}, 0, 0, 1, 0);
    const Pose T_cam_imu = poseOf(
        {-0.004591628876843622, -0.002003031393103538, -0.05479917787120936}, 0.0067828148322833575,
        -0.7111602175046777, 0.7029949006508702, 0.0018188239395917287);
    const Pose T_cam_lidar = poseOf(
        {0.00035060884033447846, -0.079574053851818, -0.053826061545697405}, 0.5034725628949727,
        0.5003337192107279, -0.4947539264483171, 0.5013981452864594);
    return {
        {"hilti-2022", poseOf({-0.001, -0.00855, 0.055}, 0.7071068, -0.7071068, 0, 0)},
        {"kitti-raw", std::nullopt},
        {"m2dgr", poseOf({-0.27255, 0.00053, -0.17954}, 0, 0, 0, 1).inverse()},
        {"mulran", poseOf({1.77, 0, 0.05}, 0, 0, 1, 0)},
        {"newer-college-2020", T_sensor_imu.inverse() * T_sensor_lidar},
        {"newer-college-2021",
         poseOf({0.013801, -0.012207, -0.01514}, 0.0032925, -0.004627, -0.0024302, 0.99998)},
        {"ntu-viral", poseOf({-0.050, 0, 0.055}, 0, 0, 0, 1)},
        {"oxford-spires", T_cam_imu.inverse() * T_cam_lidar}};
}

TEST(TheRigFilesOfPublicData, SayWhatTheirSourcesSay)
{
    const auto published = publishedPoses();
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(TAUT_RIGS))
    {
        const std::string name = entry.path().stem();
        SCOPED_TRACE(name);
        files++;
        ASSERT_EQ(published.count(name), 1U) << "add what its source says";
        const Rig rig = rigOf(name);
        const auto& want = published.at(name);
        ASSERT_EQ(rig.lidar.T_vehicle_lidar.has_value(), want.has_value());
        if (!want.has_value()) continue;
        // The IMU is the vehicle, so that the pose is T_imu_lidar, and not with the log's of the
        // IMU.
        ASSERT_TRUE(rig.imu.T_vehicle_imu.has_value());
        EXPECT_EQ(rig.imu.T_vehicle_imu->R, Matrix3d::Identity());
        EXPECT_EQ(rig.imu.T_vehicle_imu->p, Vector3d::Zero());
        const Pose& got = *rig.lidar.T_vehicle_lidar;
        EXPECT_LT((got.R * got.R.transpose() - Matrix3d::Identity()).norm(), 1e-12);
        EXPECT_NEAR(got.R.determinant(), 1, 1e-12);
        EXPECT_LT(logSO3(got.R.transpose() * want->R).norm(), 2e-6);  // four decimals of a degree
        EXPECT_LT((got.p - want->p).norm(), 1e-6);
    }
    EXPECT_EQ(files, published.size());
}

TEST(TheRigFilesOfPublicData, HaveDensitiesOrSayThatTheyAreLeftOut)
{
    for (const auto& entry : std::filesystem::directory_iterator(TAUT_RIGS))
    {
        SCOPED_TRACE(entry.path().string());
        const Rig rig = loadRig(entry.path());
        if (!rig.imu.noise.has_value())
        {
            EXPECT_THAT(readTextFile(entry.path()), HasSubstr("Noise: no densities"));
            continue;
        }
        // Of MEMS sensors and better ones: values in deg/s, in g or of single samples are
        // elsewhere.
        EXPECT_GT(rig.imu.noise->gyro, 1e-5);
        EXPECT_LT(rig.imu.noise->gyro, 1e-3);
        EXPECT_GT(rig.imu.noise->accel, 5e-4);
        EXPECT_LT(rig.imu.noise->accel, 2e-2);
    }
}

/** A recording with the topics of a set. */
class ARecordingOfPublicData : public testing::Test
{
 protected:
    void sweeps(const std::string& topic, const CloudStyle& style)
    {
        for (const Scan& scan : scans_)
            messages_.push_back(
                {topic, "sensor_msgs/PointCloud2", arrivalOf(scan),
                 CloudWriter(scan, style, TestWire::Ros1).message()});
    }
    void readings(const std::string& topic, const std::string& frame)
    {
        for (TestMessage m : readingMessages(readings_, TestWire::Ros1, frame))
        {
            m.topic = topic;
            messages_.push_back(m);
        }
    }

    /** The command of docs/public-data.md, with no warning. */
    void expectImported(
        const std::string& rig, const std::string& lidar_topic, const std::string& imu_topic,
        ScanStamp stamp = ScanStamp::Detect)
    {
        writeFile(folder_ / "a.bag", Ros1Writer::bag(merged(messages_, {}), {"lz4", 7, true}));
        ImportConfig config;
        config.path = folder_ / "a.bag";
        config.options.lidar_topic = lidar_topic;
        config.options.imu_topic = imu_topic;
        config.options.scan_stamp = stamp;
        config.rig = rigOf(rig);
        WarningLog warnings;
        Import import(config, warnings.sink());
        std::vector<Scan> scans;
        ImuSamples readings;
        while (const auto item = import.next())
            if (const auto* scan = std::get_if<Scan>(&*item))
                scans.push_back(*scan);
            else
                readings.push_back(std::get<ImuSample>(*item));
        for (const Warning& w : warnings.kept()) ADD_FAILURE() << w.kind << ": " << w.text;
        EXPECT_THAT(import.findings(), Contains("T_imu_lidar: of the rig file"));
        expectSame(scans, scans_, 1000);
        const Pose want = publishedPoses().at(rig).value();
        for (const Scan& scan : scans)
        {
            EXPECT_LT(logSO3(scan.T_imu_lidar.R.transpose() * want.R).norm(), 2e-6);
            EXPECT_LT((scan.T_imu_lidar.p - want.p).norm(), 1e-6);
        }
        ASSERT_EQ(readings.size(), readings_.size());
        EXPECT_EQ(readings.back().t, readings_.back().t);
        EXPECT_EQ(readings.back().accel, readings_.back().accel);
    }

    std::vector<Scan> scans_ = syntheticSweeps(30, 12);
    ImuSamples readings_ = syntheticReadings(30);
    TestMessages messages_;
    TemporaryFolder folder_;
};

/** Times since 1970 in doubles, as Hesai's driver writes them. */
CloudStyle hesaiStyle()
{
    CloudStyle style;
    style.frame = "PandarXT-32";
    style.time_name = "timestamp";
    style.time_type = "float64";
    style.time_unit = 1e9;
    style.absolute = true;
    return style;
}

TEST_F(ARecordingOfPublicData, Hilti2022)
{
    sweeps("/hesai/pandar", hesaiStyle());
    readings("/alphasense/imu", "imu_sensor_frame");
    expectImported("hilti-2022", "/hesai/pandar", "/alphasense/imu");
}

TEST_F(ARecordingOfPublicData, OxfordSpires)
{
    sweeps("/hesai/pandar", hesaiStyle());
    readings("/alphasense_driver_ros/imu", "imu");
    expectImported("oxford-spires", "/hesai/pandar", "/alphasense_driver_ros/imu");
}

TEST_F(ARecordingOfPublicData, NewerCollege2021WithTwoImus)
{
    sweeps("/os_cloud_node/points", {});
    readings("/os_cloud_node/imu", "os_imu");
    readings("/alphasense_driver_ros/imu", "imu");
    expectImported("newer-college-2021", "/os_cloud_node/points", "/os_cloud_node/imu");
}

TEST_F(ARecordingOfPublicData, NtuViralWithTwoLidarsStampedAtTheEnd)
{
    // Times count from the beginning of the sweep, stamps are its end.
    std::vector<Scan> stamped = scans_;
    for (Scan& scan : stamped)
    {
        const Time arrival = arrivalOf(scan);
        scan.stamp = scan.end;
        for (const char* topic : {"/os1_cloud_node1/points", "/os1_cloud_node2/points"})
            messages_.push_back(
                {topic, "sensor_msgs/PointCloud2", arrival,
                 CloudWriter(scan, {}, TestWire::Ros1).message()});
    }
    for (const char* topic : {"/imu/imu", "/os1_cloud_node1/imu", "/os1_cloud_node2/imu"})
        readings(topic, "imu");
    expectImported("ntu-viral", "/os1_cloud_node1/points", "/imu/imu", ScanStamp::End);
}
}  // namespace
}  // namespace taut::test
