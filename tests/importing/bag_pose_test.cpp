/** Where the LiDAR is on the IMU, by the transforms in a bag. */
#include <limits>

#include "bag_support.h"
#include "taut/importing/Import.h"

namespace taut::test
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Pose kBaseToImu{expSO3({0.1, -0.2, 0.3}), {0.5, 0.1, -0.2}};
const Pose kBaseToMount{expSO3({0, 0, M_PI / 2}), {0, 0, 1}};
const Pose kMountToLidar{expSO3({0.05, 0.02, -1}), {0.1, 0.2, 0.3}};
const Pose kImuToLidar = kBaseToImu.inverse() * kBaseToMount * kMountToLidar;

class ABagWithTransforms : public testing::Test
{
 protected:
    /** At some time since the bag's begin. */
    void tell(const std::vector<TestTransform>& transforms, double at = -0.1)
    {
        add("/tf_static", transforms, at);
    }
    void add(const std::string& topic, const std::vector<TestTransform>& transforms, double at)
    {
        told_.push_back(
            {topic, "tf2_msgs/TFMessage", kBagStart + fromSeconds(at),
             transformsMessage(transforms, wire_)});
    }
    void tellChain()
    {
        tell({transformOf("base_link", "imu_link", kBaseToImu)});
        tell(
            {transformOf("base_link", "mount", kBaseToMount),
             transformOf("mount", "velodyne", kMountToLidar)});
    }

    TestMessages messages() const
    {
        CloudStyle style;
        style.frame = lidar_frame_;
        return merged(
            told_, merged(
                       sweepMessages(syntheticSweeps(kSweeps, 12), style, wire_),
                       readingMessages(syntheticReadings(kSweeps), wire_, imu_frame_)));
    }

    Imported imported() const
    {
        writeFile(folder_ / "a.mcap", McapWriter::file(messages()));
        return import(folder_ / "a.mcap");
    }

    /** That the identity is taken, with a warning. */
    void expectUnknown(const std::string& cause) const
    {
        const Imported result = imported();
        ASSERT_EQ(result.scans.size(), static_cast<std::size_t>(kSweeps));
        EXPECT_EQ(result.scans[0].T_imu_lidar.R, Matrix3d::Identity());
        EXPECT_EQ(result.scans[0].T_imu_lidar.p, Vector3d::Zero());
        EXPECT_THAT(textOf(result, "pose_unknown"), AllOf(HasSubstr(cause), HasSubstr("rig file")));
        EXPECT_THAT(result.findings, HasSubstr("T_imu_lidar: not told"));
    }

    static std::string textOf(const Imported& result, const std::string& kind)
    {
        for (const Warning& w : result.warnings.kept())
            if (w.kind == kind) return w.text;
        return "no " + kind;
    }

    static void expectPose(const Imported& result, const Pose& pose = kImuToLidar)
    {
        EXPECT_TRUE(result.warnings.counts().empty());
        ASSERT_EQ(result.scans.size(), static_cast<std::size_t>(kSweeps));
        for (const Scan& scan : result.scans)
        {
            EXPECT_LT((scan.T_imu_lidar.R - pose.R).norm(), 1e-9);
            EXPECT_LT((scan.T_imu_lidar.p - pose.p).norm(), 1e-9);
        }
    }

    static constexpr int kSweeps = 30;  // longer than static transforms take to come
    TestWire wire_ = TestWire::Cdr;
    std::string lidar_frame_ = "velodyne", imu_frame_ = "imu_link";
    TestMessages told_;
    TemporaryFolder folder_;
};

TEST_F(ABagWithTransforms, GivesThePoseOverAChainInAnyContainer)
{
    tellChain();
    writeFile(folder_ / "a.mcap", McapWriter::file(messages(), {"zstd", 7, true}));
    writeSqlite3Bag(folder_ / "a.db3", messages());
    wire_ = TestWire::Ros1;
    lidar_frame_ = "/velodyne";  // as tf had it before tf2
    told_.clear();
    tellChain();
    for (TestMessage& m : told_) m.type = "tf/tfMessage", m.topic = "/robot/tf_static";
    writeFile(folder_ / "a.bag", Ros1Writer::bag(messages(), {"lz4", 7, true}));
    for (const char* name : {"a.mcap", "a.db3", "a.bag"})
    {
        const Imported result = import(folder_ / name);
        expectPose(result);
        EXPECT_THAT(
            result.findings, AllOf(
                                 HasSubstr("T_imu_lidar: x -0.3"), HasSubstr(" deg (tf_static: "),
                                 HasSubstr("imu_link <- base_link <- mount <- velodyne)")));
    }
}

TEST_F(ABagWithTransforms, GivesThePoseWhicheverOfTheTwoIsTheParent)
{
    tell({transformOf("velodyne", "imu_link", kImuToLidar.inverse())});
    expectPose(imported());
    told_.clear();
    tell({transformOf("imu_link", "velodyne", kImuToLidar)});
    expectPose(imported());
}

TEST_F(ABagWithTransforms, TakesTheTfThatDoesNotMove)
{
    for (int i = 0; i < 25; i++)
    {
        const Pose moving{expSO3({0, 0, 0.1 * i}), {0.2 * i, 0, 0}};
        add("/tf",
            {transformOf("odom", "base_link", moving),
             transformOf("base_link", "imu_link", kBaseToImu),
             transformOf("base_link", "mount", kBaseToMount)},
            0.1 * i);
    }
    tell({transformOf("mount", "velodyne", kMountToLidar)});
    const Imported result = imported();
    expectPose(result);
    EXPECT_THAT(result.findings, HasSubstr("(tf: imu_link <- base_link"));
}

TEST_F(ABagWithTransforms, DoesNotTakeATfThatMovesLate)
{
    tell({transformOf("base_link", "velodyne", kBaseToMount)});
    for (int i = 0; i < 25; i++)
    {
        const Pose tilting{expSO3({0, i < 24 ? 0 : 0.1, 0}), {0, 0, 0}};
        add("/tf", {transformOf("base_link", "imu_link", tilting)}, 0.1 * i);
    }
    expectUnknown("the transform between 'imu_link' and 'base_link' changes");
}

TEST_F(ABagWithTransforms, OfTheSameFrameNeedsNone)
{
    lidar_frame_ = "/imu_link";
    tell({transformOf("base_link", "imu_link", kBaseToImu)});
    const Imported result = imported();
    expectPose(result, {});
    EXPECT_THAT(result.findings, HasSubstr("name the same frame 'imu_link'"));
}

TEST_F(ABagWithTransforms, WithNoneSaysThatThePoseIsNotTold)
{
    const Imported result = imported();
    expectPose(result, {});
    EXPECT_THAT(result.findings, HasSubstr("T_imu_lidar: not told"));
    EXPECT_FALSE(openImportSource(folder_ / "a.mcap")->tellsPose());
    tellChain();
    imported();
    EXPECT_TRUE(openImportSource(folder_ / "a.mcap")->tellsPose());
}

TEST_F(ABagWithTransforms, NamesTheFrameThatNoTransformHas)
{
    tell({transformOf("base_link", "imu_link", kBaseToImu)});
    expectUnknown("no transform has the frame 'velodyne'");
    tell({transformOf("map", "velodyne", kBaseToMount)});
    expectUnknown("no chain of transforms joins 'imu_link' and 'velodyne'");
    imu_frame_ = "";
    expectUnknown("the messages on /ouster/imu name no frame");
}

TEST_F(ABagWithTransforms, LeavesOutWhatIsNoTransform)
{
    TestTransform bad = transformOf("imu_link", "velodyne", kImuToLidar);
    const auto leavesOut = [&](const std::string& why)
    {
        told_.clear();
        tell({bad});
        const Imported result = imported();
        EXPECT_THAT(textOf(result, "tf_invalid"), HasSubstr(why));
        EXPECT_EQ(result.warnings.count("tf_invalid"), 1U);
        expectUnknown("no transform has the frame 'imu_link'");
        tellChain();  // what is good counts all the same
        const Imported chained = imported();
        EXPECT_EQ(chained.warnings.count("pose_unknown"), 0U);
        EXPECT_LT((chained.scans[0].T_imu_lidar.p - kImuToLidar.p).norm(), 1e-9);
    };
    bad.rotation.x() = kNan;
    leavesOut("the transform of 'imu_link' to 'velodyne' is left out: its values are not finite");
    bad.rotation = Eigen::Quaterniond(0, 0, 0, 0);
    leavesOut("its quaternion has a norm of 0");
    bad.rotation = Eigen::Quaterniond(1, 0, 0, 0);
    bad.translation.y() = std::numeric_limits<double>::infinity();
    leavesOut("its values are not finite");
    bad = transformOf("velodyne", "/velodyne", {});
    leavesOut("it joins a frame with itself");
    bad.child = "/";
    leavesOut("a frame has no name");
}

TEST_F(ABagWithTransforms, WithALoopIsTakenOnlyWhereItClosesToTheSame)
{
    tellChain();
    tell({transformOf("velodyne", "imu_link", kImuToLidar.inverse())});
    expectPose(imported());
    tell({transformOf("velodyne", "base_link", Pose{})});
    expectUnknown("two ways from 'imu_link' to 'velodyne' differ by ");
    // Elsewhere a loop does no harm.
    told_.clear();
    tellChain();
    tell(
        {transformOf("mount", "a", kBaseToImu), transformOf("a", "b", kBaseToImu),
         transformOf("b", "mount", kBaseToImu)});
    expectPose(imported());
}

TEST_F(ABagWithTransforms, OfTwoParentsIsTakenOnlyWhereBothSayTheSame)
{
    tell(
        {transformOf("base_link", "imu_link", kBaseToImu),
         transformOf("base_link", "velodyne", kBaseToMount),
         transformOf("base_link", "roof", kMountToLidar),
         transformOf("roof", "velodyne", kMountToLidar.inverse() * kBaseToMount)});
    expectPose(imported(), kBaseToImu.inverse() * kBaseToMount);
    told_.clear();
    tell(
        {transformOf("base_link", "imu_link", kBaseToImu),
         transformOf("base_link", "velodyne", kBaseToMount),
         transformOf("base_link", "roof", kMountToLidar), transformOf("roof", "velodyne", {})});
    expectUnknown("differ by ");
    told_.clear();
    tell({transformOf("base_link", "imu_link", kBaseToImu)});
    tell({transformOf("base_link", "velodyne", kBaseToMount)});
    tell({transformOf("base_link", "velodyne", kMountToLidar)});
    expectUnknown("the transform between 'base_link' and 'velodyne' changes");
}

TEST_F(ABagWithTransforms, OfBrokenMessagesIsReadAllTheSame)
{
    tellChain();
    const Blob whole = told_.back().data;
    for (std::size_t size = 0; size < whole.size(); size += 9)
    {
        told_.back().data.assign(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        const Imported result = imported();
        EXPECT_EQ(result.scans.size(), static_cast<std::size_t>(kSweeps)) << size;
        EXPECT_EQ(result.warnings.count("pose_unknown"), 1U) << size;
    }
}

TEST_F(ABagWithTransforms, GivesWayToARigFile)
{
    tell({transformOf("base_link", "imu_link", kBaseToImu)});  // alone, a warning
    writeFile(folder_ / "a.mcap", McapWriter::file(messages()));
    ImportConfig config;
    config.path = folder_ / "a.mcap";
    config.rig = parseRig("lidar: {pose: {x: 1, yaw: 90}}\nimu: {pose: {z: -0.5}}\n");
    WarningLog warnings;
    Import import(config, warnings.sink());
    std::size_t scans = 0;
    while (const auto item = import.next())
    {
        const auto* scan = std::get_if<Scan>(&*item);
        if (scan == nullptr) continue;
        EXPECT_LT((scan->T_imu_lidar.p - Vector3d(1, 0, 0.5)).norm(), 1e-9);
        scans++;
    }
    EXPECT_EQ(scans, static_cast<std::size_t>(kSweeps));
    EXPECT_TRUE(import.tellsPose());
    EXPECT_TRUE(warnings.counts().empty());
    EXPECT_THAT(import.findings(), testing::Contains("T_imu_lidar: of the rig file"));
}
}  // namespace
}  // namespace taut::test
