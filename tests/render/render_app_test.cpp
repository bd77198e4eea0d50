#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>

#include <filesystem>
#include <fstream>

#include "program.h"
#include "structures.h"
#include "taut/files/PlyFile.h"
#include "taut/render/Caption.h"
#include "taut/trajectory/TrajectoryFile.h"
#include "temporary_folder.h"

using namespace taut;
using ::testing::HasSubstr;

namespace
{
/** What taut-slam leaves of a small hall. */
class RenderApp : public ::testing::Test
{
 protected:
    RenderApp()
    {
        const RenderScene hall = test::hall(2);
        PlyPointWriter map(folder_ / "map.ply");
        for (const auto& point : hall.points) map.append({point, 0});
        map.close();
        TumWriter trajectory(folder_ / "trajectory.tum");
        Time t = 0;
        for (const Pose& pose : hall.trajectory) trajectory.write({t += 100'000'000, pose});
        trajectory.close();
    }

    static test::ProgramRun run(const std::string& arguments)
    {
        return test::runProgram(TAUT_RENDER, arguments);
    }
    std::string input() const { return "-i " + (folder_ / ""); }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

    test::TemporaryFolder folder_;
};
}  // namespace

TEST_F(RenderApp, DrawsAllViewsBesideTheInput)
{
    const auto r = run(input() + " --size 320x200");
    EXPECT_EQ(r.exit_code, 0) << r.output;
    for (const View view : kAllViews)
    {
        const std::string name = "snapshot_" + std::string(nameOf(view)) + ".png";
        EXPECT_THAT(r.output, HasSubstr(folder_ / name));
        mrpt::img::CImage image;
        ASSERT_TRUE(image.loadFromFile(folder_ / name));
        EXPECT_EQ(image.getWidth(), 320U);
        EXPECT_EQ(image.getHeight(), 200U);
    }
}

TEST_F(RenderApp, DrawsOneViewIntoANewFolder)
{
    const auto r =
        run(input() + " -o " + (folder_ / "new/out") + " --view top --size 320x200 --caption hi");
    EXPECT_EQ(r.exit_code, 0) << r.output;
    EXPECT_TRUE(exists("new/out/snapshot_top.png"));
    EXPECT_FALSE(exists("new/out/snapshot_oblique.png"));
    EXPECT_FALSE(exists("snapshot_top.png"));
}

TEST_F(RenderApp, FailsWithTheCauseOnBadFiles)
{
    const auto missing = run("-i /no/such/folder");
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_THAT(missing.output, HasSubstr("/no/such/folder/map.ply"));
    std::filesystem::resize_file(
        folder_ / "map.ply", std::filesystem::file_size(folder_ / "map.ply") - 7);
    const auto truncated = run(input());
    EXPECT_EQ(truncated.exit_code, 1);
    EXPECT_THAT(truncated.output, HasSubstr("ends after"));
}

TEST_F(RenderApp, SaysWhatIsWrongWithTheCommandLine)
{
    for (const std::string bad :
         {"", "-i x --view side", "-i x --size big", "-i x --size 320", "-i x --size 320x200x1",
          "-i x --size 1x1", "-i x --size 99999x200", "-i x --nonsense"})
    {
        const auto r = run(bad);
        EXPECT_EQ(r.exit_code, 2) << bad << r.output;
        EXPECT_THAT(r.output, HasSubstr("taut-render")) << bad;
    }
    EXPECT_EQ(run("--help").exit_code, 0);
}

TEST(Caption, NamesSequenceLengthDurationAndMode)
{
    EXPECT_THAT(
        captionOf({"hall", 45.25, 44'960'000'000, "iterated"}),
        ::testing::ElementsAre("hall", "length 45.2 m, duration 45.0 s, mode iterated"));
    EXPECT_THAT(captionOf({"hall", 1, 0, ""})[1], "length 1.0 m, duration 0.0 s");
}
