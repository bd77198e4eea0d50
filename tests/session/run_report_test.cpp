#include "taut/session/RunReport.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "taut/files/PlyFile.h"
#include "taut/trajectory/TrajectoryFile.h"
#include "temporary_folder.h"

using namespace taut;
using namespace taut::test;

namespace
{
constexpr Time kBegin = 1'700'000'000'000'000'000;

/** A folder of results written by hand: 50 poses on an arc. */
class ARunReport : public ::testing::Test
{
 protected:
    ARunReport()
    {
        for (int i = 0; i < 50; i++)
        {
            const double a = 0.1 * i;
            path.push_back(
                {kBegin + i * Time{100'000'000},
                 {expSO3({0, 0, a}), {10 * std::sin(a), 10 * std::cos(a), 0.1 * i * a}}});
        }
        writeTum(folder / "trajectory.tum", path);
    }

    void write(const char* name, const std::string& text) const
    {
        std::ofstream(folder / name) << text;
    }

    Report read(const Trajectory& truth = {})
    {
        return readRunReport(
            folder / "", truth, [this](const Warning& w) { told.push_back(w.text); });
    }

    TemporaryFolder folder;
    Trajectory path;
    std::vector<std::string> told;
};
}  // namespace

TEST_F(ARunReport, NeedsNoMoreThanATrajectory)
{
    const Report report = read();
    EXPECT_EQ(report.path.size(), 50u);
    ASSERT_EQ(report.plots.size(), 2u);
    EXPECT_EQ(report.plots[1].title, "Turn rate");
    EXPECT_NEAR(report.plots[1].curves[0].values[10], 180 / M_PI, 1e-3);
    EXPECT_TRUE(report.points.empty());
    EXPECT_TRUE(told.empty());
    std::filesystem::remove(folder / "trajectory.tum");
    EXPECT_THROW(read(), std::runtime_error);
}

TEST_F(ARunReport, TellsWhatTheOtherResultsHold)
{
    PlyPointWriter ply(folder / "map.ply");
    for (const float x : {0.f, 1.f, 2.f}) ply.append({{x, 2, 3}, 10 * x});
    ply.close();
    write(
        "states.csv",
        "t,ba_x,var_ba_x,correspondences,fit\n1700000000,0.1,0.04,20,0.9\n"
        "1700000000.1,0.2,0.01,0,0\n1700000000.2,0.");
    write("metrics.json", R"({"input": {"file": "a/log.rawlog"}, "warnings": {"imu_gap": 4},
        "first_warnings": [{"t": 1700000001.5, "kind": "imu_gap", "text": "no sample"}],
        "doubtful": [{"from": 1700000001, "to": 1700000002, "cause": "imu_silent", "recovered": true}]})");
    write("config.yaml", "map: {}");
    const Report report = read();
    EXPECT_TRUE(told.empty());
    EXPECT_EQ(report.title, "log.rawlog");
    ASSERT_EQ(report.points.size(), 3u);
    EXPECT_EQ(report.points[2].intensity, 20);
    ASSERT_EQ(report.warnings.size(), 1u);
    EXPECT_EQ(report.warnings[0].count, 4u);
    EXPECT_NEAR(toSeconds(report.warnings[0].first.at(0).t - kBegin), 1.5, 1e-6);
    ASSERT_EQ(report.stretches.size(), 1u);
    EXPECT_NEAR(toSeconds(report.stretches[0].to - kBegin), 2, 1e-6);
    EXPECT_EQ(report.texts.at(0).second, "map: {}");
    for (const ReportPlot& plot : report.plots)
    {
        if (plot.title == "Accelerometer bias")
        {
            EXPECT_NEAR(plot.curves[0].half_widths.at(0), 0.6, 1e-6);
        }
        if (plot.title != "Fit") continue;
        ASSERT_EQ(plot.times.size(), 2u);  // the third row was cut short
        EXPECT_NEAR(plot.curves[0].values[0], 0.9, 1e-6);
        EXPECT_TRUE(std::isnan(plot.curves[0].values[1]));  // nothing to fit
    }
}

TEST_F(ARunReport, WarnsOfResultsThatAreDamagedAndGoesOn)
{
    write("map.ply", "ply\nformat binary_little_endian 1.0\n");
    write("metrics.json", "{\"warnings\": ");
    write("loops.csv", "from,to\n0,1\n");
    write("states.csv", "t,fit\nnever,1\n");
    const Report report = read();
    EXPECT_EQ(told.size(), 4u);
    EXPECT_EQ(report.warnings.size(), 4u);
    EXPECT_EQ(report.warnings[0].kind, "report_incomplete");
    EXPECT_EQ(report.path.size(), 50u);
}

TEST_F(ARunReport, TakesNoMetricsOfAnotherShape)
{
    // Each ended the report with an exception of the JSON library, or a cast that overflows.
    for (const char* text :
         {"[]", "7", R"({"doubtful": [{"from": 1e300, "to": 1, "cause": "", "recovered": true}]})",
          R"({"warnings": {"imu_gap": -1e300}})"})
    {
        SCOPED_TRACE(text);
        told.clear();
        write("metrics.json", text);
        const Report report = read();
        EXPECT_EQ(told.size(), 1u);
        EXPECT_EQ(report.path.size(), 50u);
    }
    for (const char* text : {R"({"input": {"file": 7}})", R"({"input": [1, 2]})"})
    {
        SCOPED_TRACE(text);
        told.clear();
        write("metrics.json", text);
        EXPECT_EQ(read().path.size(), 50u);
        EXPECT_TRUE(told.empty());
    }
}

TEST_F(ARunReport, ComparesWithTheTruthOrSaysWhyNot)
{
    const Pose T_truth_run{expSO3({0.1, 0.2, 0.3}), {4, 5, 6}};
    Trajectory truth = path;
    for (StampedPose& pose : truth) pose.T_world_imu = T_truth_run * pose.T_world_imu;
    const Report report = read(truth);
    ASSERT_TRUE(report.accuracy);
    EXPECT_EQ(report.accuracy->path.size(), 50u);
    EXPECT_LT((report.accuracy->path[30] - path[30].T_world_imu.p).norm(), 1e-6);
    EXPECT_LT(report.accuracy->plots.at(0).curves[0].values[10], 1e-6);

    for (StampedPose& pose : truth) pose.t += Time{3600'000'000'000};
    const Report elsewhen = read(truth);
    ASSERT_TRUE(elsewhen.accuracy);
    EXPECT_EQ(elsewhen.accuracy->headline.rfind("Not scored: ", 0), 0u);
}
