#include "taut/trajectory/PointTruth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "temporary_file.h"

using namespace taut;
using taut::test::TemporaryFile;
using ::testing::HasSubstr;

namespace
{
const Eigen::Vector3f kDropped = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());

void write(const TemporaryFile& file, const std::vector<UndistortedScan>& scans)
{
    PointTruthWriter writer(file.path());
    for (const UndistortedScan& scan : scans) writer.write(scan);
    writer.close();
}

std::string errorOf(const TemporaryFile& truth, const TemporaryFile& estimate)
{
    try
    {
        scorePoints(truth.path(), estimate.path());
    }
    catch (const std::runtime_error& e)
    {
        return e.what();
    }
    return "no error";
}
}  // namespace

TEST(PointTruth, FileHasTheExpectedBytes)
{
    const TemporaryFile file;
    write(file, {{0x0102030405060708, {{1, 0, -2}}}});
    const char expected[] =
        "TAUTPNTS\x01\0\0\0"
        "\x08\x07\x06\x05\x04\x03\x02\x01"
        "\x01\0\0\0"
        "\0\0\x80\x3f"
        "\0\0\0\0"
        "\0\0\0\xc0";
    EXPECT_EQ(file.content(), std::string(expected, sizeof expected - 1));
}

TEST(PointTruth, MakesTheRoundTrip)
{
    const TemporaryFile file;
    write(file, {{1, {{1, 2, 3}, kDropped}}, {2, {}}, {3, {{4, 5, 6}}}});
    PointTruthReader reader(file.path());
    UndistortedScan scan;
    ASSERT_TRUE(reader.next(scan));
    EXPECT_EQ(scan.stamp, 1);
    ASSERT_EQ(scan.positions.size(), 2u);
    EXPECT_EQ(scan.positions[0], Eigen::Vector3f(1, 2, 3));
    EXPECT_TRUE(scan.positions[1].array().isNaN().all());
    ASSERT_TRUE(reader.next(scan));
    EXPECT_TRUE(scan.positions.empty());
    ASSERT_TRUE(reader.next(scan));
    EXPECT_EQ(scan.positions[0], Eigen::Vector3f(4, 5, 6));
    EXPECT_FALSE(reader.next(scan));
    EXPECT_FALSE(reader.next(scan));
}

TEST(PointTruth, BrokenFilesAreErrorsThatNameThem)
{
    const TemporaryFile good("", "points.good"), bad("", "points.bad");
    write(good, {{1, {{1, 2, 3}}}, {2, {{1, 2, 3}}}});
    const std::string content = good.content();
    const auto errorWith = [&](const std::string& bytes)
    {
        bad.write(bytes);
        return errorOf(good, bad);
    };
    EXPECT_EQ(errorWith(content), "no error");
    for (std::size_t size = 0; size < content.size(); size++)
    {
        if (size == 36) continue;  // the end of the first scan: a shorter file, but a whole one
        EXPECT_THAT(errorWith(content.substr(0, size)), HasSubstr(".bad")) << size;
    }
    EXPECT_THAT(errorWith(content.substr(0, 40)), HasSubstr(".bad, scan 1: the file is cut short"));
    EXPECT_THAT(errorWith("PLY" + content.substr(3)), HasSubstr("is not a file of undistorted"));
    EXPECT_THAT(errorWith(content.substr(0, 8) + '\2' + content.substr(9)), HasSubstr("version 2"));
    EXPECT_THAT(
        errorWith(content.substr(0, 20) + "\xff\xff\xff\xff" + content.substr(24)),
        HasSubstr("scan 0: it claims 4294967295 points"));
    EXPECT_THAT(errorWith(content + content.substr(12)), HasSubstr("scan 2: its stamp does not"));
}

TEST(PointScores, AreTheDistancesOfThePointsKnownToBoth)
{
    const TemporaryFile truth("", "points.truth"), estimate("", "points.estimate");
    write(truth, {{100'000, {{0, 0, 0}, kDropped, {1, 1, 1}}}, {200'000, {{0, 0, 0}, {5, 5, 5}}}});
    write(
        estimate, {{50'000, {{9, 9, 9}}},  // has no truth
                   {100'900, {{0, 3, 4}, {1, 2, 3}, kDropped}},
                   {200'000, {{0, 0, 1}, {5, 5, 5}}}});
    const PointScores scores = scorePoints(truth.path(), estimate.path());
    EXPECT_EQ(scores.scans, 2u);
    EXPECT_EQ(scores.truth_scans, 2u);
    EXPECT_EQ(scores.points, 3u);
    EXPECT_EQ(scores.missing, 1u);
    EXPECT_NEAR(scores.rmse, std::sqrt(26.0 / 3), 1e-12);
    EXPECT_NEAR(scores.mean, 2, 1e-12);
    EXPECT_NEAR(scores.max, 5, 1e-12);
    EXPECT_NEAR(scores.worst_scan, 5, 1e-12);
    EXPECT_EQ(scores.worst_stamp, 100'900);
    EXPECT_NEAR(scores.median_scan, (5 + std::sqrt(0.5)) / 2, 1e-12);
}

TEST(PointScores, SayWhyNothingCanBeCompared)
{
    const TemporaryFile truth("", "points.truth"), estimate("", "points.estimate");
    write(truth, {{100'000, {{0, 0, 0}}}});
    write(estimate, {{105'000, {{0, 0, 0}}}});
    EXPECT_THAT(errorOf(truth, estimate), HasSubstr("closest stamps differ by 0.000005000 s"));
    write(estimate, {});
    EXPECT_THAT(errorOf(truth, estimate), HasSubstr("holds 0 of the 1 scans with true points"));
    write(estimate, {{100'000, {{0, 0, 0}, {1, 1, 1}}}});
    EXPECT_THAT(errorOf(truth, estimate), HasSubstr("has 2 points, its truth 1"));
}

TEST(PointScores, OfTooFewPointsAreRefused)
{
    const TemporaryFile truth("", "points.truth"), estimate("", "points.estimate");
    write(truth, {{1'000'000, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}}});
    write(estimate, {{1'000'000, {{0, 0, 0}, kDropped, kDropped}}});
    EXPECT_THAT(errorOf(truth, estimate), HasSubstr("holds 1 of the 3 true points"));
    EXPECT_EQ(scorePoints(truth.path(), estimate.path(), 0.3).missing, 2u);
}

TEST(PointScores, OfTooFewScansAreRefused)
{
    const TemporaryFile truth("", "points.truth"), estimate("", "points.estimate");
    write(truth, {{1'000'000, {{0, 0, 0}}}, {2'000'000, {{0, 0, 0}}}, {3'000'000, {{0, 0, 0}}}});
    write(estimate, {{2'000'000, {{0, 0, 0}}}});
    EXPECT_THAT(errorOf(truth, estimate), HasSubstr("holds 1 of the 3 scans with true points"));
    EXPECT_EQ(scorePoints(truth.path(), estimate.path(), 0.3).scans, 1u);
    write(estimate, {{2'000'000, {{0, 0, 0}}}, {3'000'000, {{0, 0, 0}}}});
    EXPECT_EQ(errorOf(truth, estimate), "no error");
}

TEST(PointTruth, WriterRefusesStampsThatDoNotIncrease)
{
    const TemporaryFile file;
    PointTruthWriter writer(file.path());
    writer.write({7, {}});
    EXPECT_THROW(writer.write({7, {}}), std::invalid_argument);
}
