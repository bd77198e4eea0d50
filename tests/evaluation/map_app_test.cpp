#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "program.h"
#include "surfaces.h"
#include "taut/evaluation/Report.h"
#include "taut/files/PlyFile.h"
#include "taut/trajectory/TrajectoryFile.h"
#include "temporary_folder.h"

using namespace taut;
using ::testing::HasSubstr;

namespace
{
test::ProgramRun run(const std::string& arguments)
{
    return test::runProgram(TAUT_EVALUATE, arguments);
}

nlohmann::json mapOf(const std::string& arguments)
{
    const test::ProgramRun r = run(arguments + " --json");
    EXPECT_EQ(r.exit_code, 0) << r.output;
    return r.exit_code == 0 ? nlohmann::json::parse(r.output)["map"] : nlohmann::json();
}

/** A room and a map of it, in a frame of its own. */
class EvaluateMap : public testing::Test
{
 protected:
    EvaluateMap()
    {
        writeMesh(mesh_, test::boxMesh({6, 5, 3}), "a room");
        writeMap(test::moved(T_map_truth_, test::boxPoints({6, 5, 3}, 0.06)));
    }
    void writeMap(const test::Points& points) const
    {
        PlyPointWriter writer(map_);
        for (const auto& p : points) writer.append({p, 1});
        writer.close();
    }

    const Pose T_map_truth_{expSO3({0, 0, 0.05}), {0.2, 0.1, 0.1}};
    test::TemporaryFolder folder_;
    std::string map_ = folder_ / "map.ply", mesh_ = folder_ / "truth.ply";
};
}  // namespace

TEST_F(EvaluateMap, ByItself)
{
    const auto map = mapOf("--map " + map_);
    EXPECT_GT(map["points"], 30'000);
    EXPECT_EQ(map["walls"]["window_m"], 0.5);
    EXPECT_NEAR(map["walls"]["median_m"], 0, 1e-5);
    EXPECT_GT(map["walls"]["planes"], 100);
    EXPECT_LT(map["entropy"]["mean_nat"], -5);
    EXPECT_FALSE(map.contains("truth"));
    const test::ProgramRun table = run("--map " + map_);
    EXPECT_THAT(table.output, HasSubstr("walls                    0.0000"));
    EXPECT_THAT(table.output, HasSubstr("mean map entropy         -"));
    EXPECT_EQ(table.output.find("ATE"), std::string::npos);
}

TEST_F(EvaluateMap, LaidOnItsTruth)
{
    const auto map = mapOf("--map " + map_ + " --map-truth " + mesh_);
    const auto& truth = map["truth"];
    EXPECT_EQ(truth["kind"], "mesh");
    EXPECT_EQ(truth["triangles"], 12);
    EXPECT_NEAR(truth["area_m2"], 126, 1e-6);
    EXPECT_EQ(truth["alignment"], "icp");
    EXPECT_EQ(truth["icp"]["directions"], 6);
    EXPECT_LT(truth["distance_m"]["rmse"], 1e-4);
    EXPECT_NEAR(truth["T_truth_map"][2][3], -0.1, 1e-3);
    EXPECT_EQ(truth["completeness"], 1);
    EXPECT_EQ(
        mapOf(
            "--map " + map_ + " --map-truth " + mesh_ +
            " --align yaw")["truth"]["icp"]["directions"],
        4);

    const auto as_it_is = mapOf("--map " + map_ + " --align none --map-truth " + mesh_)["truth"];
    EXPECT_EQ(as_it_is["alignment"], "none");
    EXPECT_GT(as_it_is["distance_m"]["median"], 0.05);
    EXPECT_LT(as_it_is["completeness"], 0.5);
    EXPECT_THAT(
        run("--map " + map_ + " --map-truth " + mesh_).output,
        HasSubstr("completeness             100.00 % of the truth has a point within 0.05 m"));
}

TEST_F(EvaluateMap, LaidByItsTrajectory)
{
    Trajectory truth, estimate;
    for (int i = 0; i <= 100; i++)
    {
        const double a = 0.06 * i;
        const Pose T{
            expSO3({0, 0, a}), {3 + std::cos(a), 2 + std::sin(a), 1 + 0.3 * std::sin(2 * a)}};
        truth.push_back({1'000'000'000 + i * 100'000'000LL, T});
        estimate.push_back({truth.back().t, T_map_truth_ * T});
    }
    writeTum(folder_ / "truth.tum", truth);
    writeTum(folder_ / "estimate.tum", estimate);
    const std::string poses =
        "--truth " + folder_ / "truth.tum" + " --estimate " + folder_ / "estimate.tum";
    const test::ProgramRun r = run(poses + " --json --map " + map_ + " --map-truth " + mesh_);
    ASSERT_EQ(r.exit_code, 0) << r.output;
    const auto json = nlohmann::json::parse(r.output);
    EXPECT_LT(json["ate"]["position_m"]["rmse"], 1e-5);
    EXPECT_EQ(json["map"]["truth"]["alignment"], "trajectory");
    EXPECT_EQ(json["map"]["truth"]["T_truth_map"], json["T_truth_estimate"]);
    EXPECT_LT(json["map"]["truth"]["distance_m"]["max"], 1e-4);
    const test::ProgramRun table = run(poses + " --map " + map_ + " --map-truth " + mesh_);
    EXPECT_THAT(table.output, HasSubstr("ATE position"));
    EXPECT_THAT(table.output, HasSubstr("map laid   by trajectory"));
}

TEST_F(EvaluateMap, AgainstACloudAndWithinADistance)
{
    const std::string cloud = folder_ / "cloud.ply";
    PlyPointWriter writer(cloud);
    for (const auto& p : test::boxPoints({6, 5, 3}, 0.05)) writer.append({p, 1});
    writer.close();
    const auto truth =
        mapOf("--map " + map_ + " --map-truth " + cloud + " --map-within 0.1")["truth"];
    EXPECT_EQ(truth["kind"], "cloud");
    EXPECT_NEAR(truth["spacing_m"], 0.05, 0.002);
    EXPECT_EQ(truth["within_m"], 0.1);
    EXPECT_EQ(truth["completeness"], 1);
    EXPECT_LT(truth["distance_m"]["max"], 0.04) << "half a diagonal of its cells";
    EXPECT_GT(truth["distance_m"]["mean"], 0.005) << "between its points";
}

TEST_F(EvaluateMap, TellsPointsThatAreNotFinite)
{
    std::ofstream(map_, std::ios::binary | std::ios::trunc)
        << "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"
           "property float y\nproperty float z\nend_header\n"
        << std::string(12, '\0') << std::string("\0\0\xc0\x7f\0\0\0\0\0\0\0\0", 12);
    EXPECT_EQ(mapOf("--map " + map_)["not_finite_points"], 1);
    EXPECT_THAT(run("--map " + map_).output, HasSubstr("1 more are not finite, left out"));
}

TEST_F(EvaluateMap, RefusesAMapOfAnotherPlace)
{
    writeMap(test::moved({Matrix3d::Identity(), {80, 0, 0}}, test::boxPoints({6, 5, 3}, 0.1)));
    const test::ProgramRun r = run("--map " + map_ + " --map-truth " + mesh_);
    EXPECT_EQ(r.exit_code, 1);
    EXPECT_THAT(r.output, HasSubstr("refused: 0.0 % of the map's points"));
    const std::string as_it_is = "--align none --map " + map_ + " --map-truth " + mesh_;
    EXPECT_NEAR(mapOf(as_it_is)["truth"]["distance_m"]["max"], 80, 0.1);
    EXPECT_EQ(run(as_it_is + " --map-reach 1").exit_code, 1);
}

TEST_F(EvaluateMap, SaysWhatIsWrong)
{
    const std::string map = "--map " + map_;
    for (const std::string& bad :
         {std::string("--map-truth ") + mesh_, map + " --truth x", map + " --loops x",
          map + " --plot x", map + " --map-within 0.1", map + " --map-reach 0 --map-truth " + mesh_,
          map + " --threads -1"})
        EXPECT_EQ(run(bad).exit_code, 2) << bad;
    EXPECT_THAT(run(map + " --loops x").output, HasSubstr("--loops needs --truth and --estimate"));
    EXPECT_EQ(run("--map /none").exit_code, 1);
    EXPECT_EQ(run(map + " --map-truth /none").exit_code, 1);
    PlyPointWriter(map_).close();
    const test::ProgramRun empty = run(map);
    EXPECT_EQ(empty.exit_code, 1);
    EXPECT_THAT(empty.output, HasSubstr("holds no points"));
}

TEST(Report, TellsLoopsAsJson)
{
    LoopScores loops;
    loops.loops = 4;
    loops.wrong = 1;
    loops.revisits = 5;
    loops.recognised = 2;
    loops.largest_error = 0.25;
    loops.nees = 1.5;
    Evaluation evaluation;
    evaluation.loops = loops;
    const auto json = nlohmann::json::parse(scoresAsJson(evaluation));
    EXPECT_EQ(json["loops"], nlohmann::json::parse(R"({"loops": 4, "wrong": 1, "precision": 0.75,
            "revisits": 5, "recognised": 2, "recall": 0.4, "largest_error_m": 0.25,
            "nees_per_dof": 1.5})"));
    EXPECT_EQ(json.size(), 1U);
    evaluation.loops = LoopScores();
    const auto none = nlohmann::json::parse(scoresAsJson(evaluation))["loops"];
    EXPECT_TRUE(none["precision"].is_null());
    EXPECT_TRUE(none["recall"].is_null());
    EXPECT_THAT(scoresAsText(evaluation), HasSubstr("0 in the graph"));
}
