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
}  // namespace
