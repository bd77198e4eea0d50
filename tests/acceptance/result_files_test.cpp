#include <gmock/gmock.h>
#include <octomap/octomap.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "slam_program.h"
#include "taut/files/PlyFile.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;
using testing::StartsWith;

constexpr std::size_t kScans = 124;  // of the sample

/** Number of lines below the head; fails unless each has as many columns as the head. */
std::size_t rowsOf(const std::string& csv)
{
    std::istringstream text(contentOf(csv));
    std::string line;
    std::getline(text, line);
    const auto commas = std::count(line.begin(), line.end(), ',');
    EXPECT_GT(commas, 5) << csv;
    std::size_t rows = 0;
    while (std::getline(text, line))
    {
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << csv << ", row " << rows;
        rows++;
    }
    return rows;
}

void expectOctreesAgree(const std::string& bt, const std::string& ot)
{
    octomap::OcTree binary(0.1);
    ASSERT_TRUE(binary.readBinary(bt));
    const std::unique_ptr<octomap::AbstractOcTree> full(octomap::AbstractOcTree::read(ot));
    ASSERT_NE(full, nullptr);
    EXPECT_GT(binary.getNumLeafNodes(), 1000U);
    EXPECT_DOUBLE_EQ(full->getResolution(), binary.getResolution());
    EXPECT_GE(full->size(), binary.size());
}

TEST(ASampleRun, GivesEveryFileAndMillimetres)
{
    const TemporaryFolder folder;
    const std::string out = folder / "out";
    const ProgramRun run = slam("-i " + kSample + " -o " + out + " --threads 2");
    ASSERT_EQ(run.exit_code, 0) << run.output;

    EXPECT_EQ(readTum(out + "/trajectory.tum").size(), kScans);
    EXPECT_EQ(readKitti(out + "/trajectory_kitti.txt").size(), kScans);
    EXPECT_LT(positionError(kSampleTruth, out + "/trajectory.tum"), 0.00125);  // measured: 0.82 mm

    EXPECT_EQ(rowsOf(out + "/states.csv"), kScans);
    EXPECT_EQ(rowsOf(out + "/timing.csv"), kScans);
    EXPECT_GT(readPlyPoints(out + "/map.ply").size(), 100'000U);
    expectOctreesAgree(out + "/map.bt", out + "/map.ot");
    for (const char* view : {"top", "oblique", "follow"})
    {
        const std::string png = contentOf(out + "/snapshot_" + view + ".png");
        EXPECT_THAT(png, StartsWith("\x89PNG"));
        EXPECT_GT(png.size(), 50'000U) << view << " is almost empty";
    }
    const auto metrics = nlohmann::json::parse(contentOf(out + "/metrics.json"));
    EXPECT_EQ(metrics["input"]["scans"], kScans);
    EXPECT_EQ(
        metrics["input"]["sha256"],
        "dc1c903b2c63292cc9b565d55711253da396173494706415e81b91c6b6fe81c7");
    EXPECT_EQ(metrics["result"]["poses"], kScans);
    EXPECT_GT(metrics["result"]["coverage"], 0.98);
    EXPECT_NEAR(metrics["result"]["length_m"], 18.56, 0.1);
}

TEST(ASampleRun, LeavesAPageThatCanBeMadeAgain)
{
    const TemporaryFolder folder;
    const std::string out = folder / "out", again = folder / "again.html";
    const std::string truth = " --truth " + kSampleTruth;
    ASSERT_EQ(slam(kSample, out, truth).exit_code, 0);
    const std::string page = contentOf(out + "/report.html");
    EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
    EXPECT_THAT(page, testing::HasSubstr("<title>hall_fast.rawlog</title>"));
    EXPECT_THAT(page, testing::HasSubstr("RMSE against the truth"));
    EXPECT_LT(page.size(), 5'000'000U);
    const ProgramRun made = runProgram(TAUT_PROGRAMS "/taut-report", out + truth + " -o " + again);
    EXPECT_EQ(made.exit_code, 0) << made.output;
    EXPECT_TRUE(contentOf(again) == page);

    const ProgramRun without = slam(kSample, folder / "without", "--no-report --only-first-n 40");
    EXPECT_EQ(without.exit_code, 0) << without.output;
    EXPECT_FALSE(std::filesystem::exists(folder / "without/report.html"));
    EXPECT_EQ(runProgram(TAUT_PROGRAMS "/taut-report", folder / "absent").exit_code, 1);
}

TEST(ASampleRun, WorksByThePaper)
{
    const TemporaryFolder folder;
    const std::string out = folder / "out";
    const ProgramRun run = slam(kSample, out, "-c " TAUT_CONFIG "/paper.yaml");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_LT(positionError(kSampleTruth, out + "/trajectory.tum"), 0.0074);  // measured: 4.9 mm
}
}  // namespace
