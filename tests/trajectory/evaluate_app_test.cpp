#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "motions.h"
#include "program.h"
#include "taut/trajectory/PointTruth.h"
#include "taut/trajectory/TrajectoryFile.h"
#include "temporary_file.h"

using namespace taut;
using ::testing::HasSubstr;

namespace
{
test::ProgramRun run(const std::string& arguments)
{
    return test::runProgram(TAUT_EVALUATE, arguments);
}

/** Truth at 100 Hz, and an estimate at 10 Hz that is off by 3 cm and seen from another world. */
class EvaluateApp : public testing::Test
{
 protected:
    EvaluateApp()
    {
        writeTum(truth_, test::lissajous(20, 100));
        const Pose T{expSO3({0, 0, 1}), {1, 2, 3}};
        Trajectory estimate = test::moved(T, test::lissajous(20, 10));
        for (std::size_t i = 0; i < estimate.size(); i++)
            estimate[i].T_world_imu.p.z() += i % 2 == 0 ? 0.03 : -0.03;
        writeTum(estimate_, estimate);
    }
    std::string files() const { return "--truth " + truth_ + " --estimate " + estimate_; }

    test::TemporaryFolder folder_;
    std::string truth_ = folder_ / "truth.tum", estimate_ = folder_ / "estimate.tum";
};
}  // namespace

TEST_F(EvaluateApp, PrintsATable)
{
    const test::ProgramRun r = run(files());
    EXPECT_EQ(r.exit_code, 0);
    EXPECT_THAT(r.output, HasSubstr("coverage   100.0 % of 20.000 s"));
    EXPECT_THAT(r.output, HasSubstr("ATE position"));
    EXPECT_THAT(r.output, HasSubstr("KITTI 100..800 m         none"));
}

TEST_F(EvaluateApp, WarnsOfThreeRepeatedPosesAndCountsTheOthers)
{
    Trajectory truth = readTum(truth_);
    std::string text = "\xEF\xBB\xBF";  // a byte order mark, too
    for (const StampedPose& pose : truth) text += tumLine(pose) + "\n" + tumLine(pose) + "\n";
    std::ofstream(truth_) << text;
    const test::ProgramRun r = run(files());
    EXPECT_EQ(r.exit_code, 0);
    EXPECT_THAT(r.output, HasSubstr("ATE position"));
    std::size_t lines = 0;
    for (auto at = r.output.find("a second pose"); at != std::string::npos;
         at = r.output.find("a second pose", at + 1))
        lines++;
    EXPECT_EQ(lines, 3U);
    EXPECT_THAT(r.output, HasSubstr("repeated_stamp"));  // how many more
}

TEST_F(EvaluateApp, WritesJson)
{
    const test::ProgramRun r = run(files() + " --json --align yaw --rpe-seconds 2 --rpe-metres 3");
    ASSERT_EQ(r.exit_code, 0);
    const auto json = nlohmann::json::parse(r.output);
    EXPECT_EQ(json["paired_poses"], 201);
    EXPECT_EQ(json["alignment"], "yaw");
    EXPECT_NEAR(json["ate"]["position_m"]["rmse"], 0.03, 1e-4);
    EXPECT_EQ(json["rpe"]["over_time"][0]["delta_s"], 2);
    EXPECT_EQ(json["rpe"]["over_distance"][0]["delta_m"], 3);
    EXPECT_TRUE(json["kitti_segments"]["translation_percent"].is_null());
    EXPECT_GT(json["short_segments"]["count"], 0);
}

TEST_F(EvaluateApp, ScoresPoints)
{
    for (const std::string name : {"truth", "estimate"})
    {
        PointTruthWriter writer(folder_ / (name + ".points"));
        writer.write({test::kStart, {{1, 2, name == "truth" ? 3.0F : 3.25F}}});
        writer.close();
    }
    const std::string truth = " --points-truth " + folder_ / "truth.points";
    const test::ProgramRun r =
        run(files() + " --json" + truth + " --points " + folder_ / "estimate.points");
    ASSERT_EQ(r.exit_code, 0) << r.output;
    EXPECT_EQ(nlohmann::json::parse(r.output)["points"]["rmse_m"], 0.25);
    EXPECT_EQ(run(files() + truth).exit_code, 2);
}

TEST_F(EvaluateApp, LeavesOutWhatIsTooEarly)
{
    Trajectory estimate = readTum(estimate_);
    for (StampedPose& pose : estimate)  // wrong in the first 5 s alone
        if (toSeconds(pose.t - test::kStart) < 4.95) pose.T_world_imu.p.x() += 9;
    writeTum(estimate_, estimate);
    for (const std::string name : {"truth", "estimate"})
    {
        PointTruthWriter writer(folder_ / (name + ".points"));
        writer.write({test::kStart, {{1, 2, name == "truth" ? 3.0F : 9.0F}}});
        writer.write({test::kStart + fromSeconds(6), {{1, 2, name == "truth" ? 3.0F : 3.5F}}});
        writer.close();
    }
    const test::ProgramRun r =
        run(files() + " --json --from-time 5 --points-truth " + folder_ / "truth.points --points " +
            folder_ / "estimate.points");
    ASSERT_EQ(r.exit_code, 0) << r.output;
    const auto json = nlohmann::json::parse(r.output);
    EXPECT_EQ(json["paired_poses"], 151);
    EXPECT_NEAR(json["coverage"]["truth_span_s"], 15, 1e-6);
    EXPECT_NEAR(json["ate"]["position_m"]["rmse"], 0.03, 1e-4);
    EXPECT_EQ(json["points"]["rmse_m"], 0.5);
    EXPECT_EQ(json["points"]["truth_scans"], 1);
    EXPECT_EQ(run(files() + " --from-time -1").exit_code, 2);
    EXPECT_EQ(run(files() + " --from-time 100").exit_code, 1);
}

TEST_F(EvaluateApp, RefusesWithExitCode1)
{
    writeTum(estimate_, test::lissajous(5, 10));
    const test::ProgramRun r = run(files());
    EXPECT_EQ(r.exit_code, 1);
    EXPECT_THAT(r.output, HasSubstr("refused: the estimate covers 25.0 %"));
    EXPECT_EQ(run(files() + " --min-coverage 0.2").exit_code, 0);
}

TEST_F(EvaluateApp, FailsWithExitCode1)
{
    std::ofstream(estimate_) << "1 2 3\n";
    const test::ProgramRun r = run(files());
    EXPECT_EQ(r.exit_code, 1);
    EXPECT_THAT(r.output, HasSubstr("estimate.tum:1: 8 columns expected, found 3"));
    EXPECT_EQ(run("--truth /none --estimate /none").exit_code, 1);
}

TEST_F(EvaluateApp, TellsBadUsageWithExitCode2)
{
    EXPECT_EQ(run("").exit_code, 2);
    EXPECT_EQ(run(files() + " --unknown").exit_code, 2);
    EXPECT_EQ(run(files() + " --align sim3").exit_code, 2);
    EXPECT_EQ(run(files() + " --min-poses -3").exit_code, 2);
    EXPECT_EQ(run(files() + " --rpe-metres 0").exit_code, 2);
    EXPECT_EQ(run(files() + " --plot-format gif").exit_code, 2);
    EXPECT_EQ(run("--help").exit_code, 0);
    EXPECT_EQ(run("--version").exit_code, 0);
}

TEST_F(EvaluateApp, DrawsPlots)
{
    if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is absent";
    for (const std::string format : {"svg", "png"})
    {
        const test::ProgramRun r =
            run(files() + " --plot '" + folder_ / "a plot" + "' --plot-format " + format);
        ASSERT_EQ(r.exit_code, 0) << r.output;
        for (const char* name : {"trajectory.", "position_error.", "rotation_error."})
            EXPECT_GT(std::filesystem::file_size(folder_ / "a plot/" + name + format), 2000u);
    }
}

TEST_F(EvaluateApp, SaysWhenItCannotDraw)
{
    const test::ProgramRun r = run(files() + " --plot " + truth_);
    EXPECT_EQ(r.exit_code, 1);
    EXPECT_THAT(r.output, HasSubstr("ATE position")) << "the scores come all the same";
}
