#include <gtest/gtest.h>

#include "slam_program.h"
#include "temporary_folder.h"

namespace
{
using namespace taut::test;

TEST(ARun, GivesTheSameBitsAgainAndWithTwoThreads)
{
    const TemporaryFolder folder;
    for (const char* run : {"1 first", "1 again", "2 threads"})
    {
        const std::string arguments =
            " -w --no-pictures --threads " + std::string(run, 1) + " -o " + (folder / (run + 2));
        ASSERT_EQ(slam("-i " + kSample + arguments).exit_code, 0);
    }
    for (const char* file : {"/trajectory.tum", "/states.csv", "/map.ply", "/map.ot"})
    {
        const std::string first = contentOf((folder / "first") + file);
        ASSERT_FALSE(first.empty());
        EXPECT_TRUE(first == contentOf((folder / "again") + file)) << file;
        EXPECT_TRUE(first == contentOf((folder / "threads") + file)) << file;
    }
}

TEST(ARun, IsRepeatedByTheConfigurationThatItLeaves)
{
    const TemporaryFolder folder;
    const std::string part = " --only-first-n 70 ";
    ASSERT_EQ(
        slam(
            kSample, folder / "a",
            part + "-s estimation.undistortion=iterated -s features.max_points=1000 -s "
                   "imu.gyro_noise=0.0031")
            .exit_code,
        0);
    ASSERT_EQ(slam(kSample, folder / "b", part + "-c " + (folder / "a/config.yaml")).exit_code, 0);
    ASSERT_EQ(slam(kSample, folder / "other", part).exit_code, 0);

    const std::string trajectory = contentOf(folder / "a/trajectory.tum");
    ASSERT_FALSE(trajectory.empty());
    EXPECT_TRUE(trajectory == contentOf(folder / "b/trajectory.tum"));
    EXPECT_EQ(contentOf(folder / "a/config.yaml"), contentOf(folder / "b/config.yaml"));
    EXPECT_FALSE(trajectory == contentOf(folder / "other/trajectory.tum"));
}

TEST(ARun, IsRepeatedByTheRigThatItLeaves)
{
    const TemporaryFolder folder;
    const std::string part = " --only-first-n 70 -s features.max_points=1000 ";
    std::ofstream(folder / "rig.yaml")
        << "lidar: {clock_offset: 0.0012345678901234}\n"
           "imu: {noise: {gyro: 0.00123456789012345678, accel: 0.0333333333333333333}}\n";
    ASSERT_EQ(slam(kSample, folder / "a", part + "-r " + (folder / "rig.yaml")).exit_code, 0);
    const std::string a = folder / "a/";
    ASSERT_EQ(
        slam(kSample, folder / "b", part + "-c " + a + "config.yaml -r " + a + "rig.yaml")
            .exit_code,
        0);
    EXPECT_TRUE(contentOf(a + "trajectory.tum") == contentOf(folder / "b/trajectory.tum"));
    EXPECT_EQ(contentOf(a + "config.yaml"), contentOf(folder / "b/config.yaml"));
    EXPECT_NE(contentOf(a + "config.yaml").find("0.0012345678901234567"), std::string::npos);
}

TEST(ARun, OfTheExampleRigsNoiseIsThatOfTheDefaults)
{
    const TemporaryFolder folder;
    std::ofstream(folder / "rig.yaml") << "imu: {noise: {}}\n";
    const std::string show = "--show-config -i a -o b ";
    const std::string given = slam(show + "-r " + (folder / "rig.yaml")).output;
    EXPECT_EQ(given, slam(show + "-s imu.noise_from_rest=false").output);
}

TEST(TheDefaultMethod, IsWhatEveryKeyIsByDefault)
{
    const TemporaryFolder folder;
    std::ofstream(folder / "nothing.yaml") << "";
    const std::string show = "--show-config -i a -o b ";
    const std::string defaults = slam(show).output;
    EXPECT_EQ(defaults, slam(show + "-c " + (folder / "nothing.yaml")).output);
    EXPECT_NE(defaults.find("gyro_noise: 0.0002"), std::string::npos);
    // The file says nothing but in comments.
    std::ifstream file(TAUT_CONFIG "/default.yaml");
    for (std::string line; std::getline(file, line);)
        EXPECT_TRUE(line.empty() || line[0] == '#') << line;
}
}  // namespace
