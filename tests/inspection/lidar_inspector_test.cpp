#include <gmock/gmock.h>

#include "taut/inspection/LidarInspector.h"

namespace
{
using namespace taut;
using testing::ElementsAre;
using testing::IsEmpty;
constexpr Duration kMillisecond = 1'000'000;
constexpr Time kStart = 1'700'000'000'000'000'000;

/** A scan of 100 points from `from` to `to` [ms] after its stamp. */
Scan scanAt(int milliseconds, double from = 0, double to = 99)
{
    Scan scan;
    scan.stamp = kStart + milliseconds * kMillisecond;
    scan.rings = 4;
    for (int i = 0; i < 100; i++)
    {
        LidarPoint p;
        p.position = {5, 1, 0.1f * static_cast<float>(i)};
        p.offset = static_cast<std::int32_t>((from + (to - from) * i / 99) * kMillisecond);
        scan.points.push_back(p);
    }
    scan.end = scan.stamp + scan.points.back().offset;
    scan.already_undistorted = from == to;
    return scan;
}

std::vector<std::string> kindsOf(const LidarInspector& inspector)
{
    std::vector<std::string> kinds;
    for (const Finding& f : inspector.findings(inspector.facts())) kinds.push_back(f.kind);
    return kinds;
}

TEST(ALidar, WithoutFaultsGivesNoFinding)
{
    LidarInspector inspector;
    for (int k = 0; k < 50; k++) inspector.add(scanAt(100 * k));
    EXPECT_THAT(kindsOf(inspector), IsEmpty());
    const LidarFacts f = inspector.facts();
    EXPECT_EQ(f.scans, 50U);
    EXPECT_NEAR(f.rate, 10, 1e-6);
    EXPECT_NEAR(f.sweep, 0.099, 1e-9);
    EXPECT_EQ(f.min_points, 100U);
    EXPECT_EQ(f.max_points, 100U);
    EXPECT_EQ(f.rings, 4);
    EXPECT_NEAR(f.stamp_at, 0, 1e-9);
    EXPECT_EQ(f.begin, kStart);
    EXPECT_EQ(f.end, kStart + 4999 * kMillisecond);
}

TEST(ALidar, ThatLosesScansTellsWhen)
{
    LidarInspector inspector;
    for (int k = 0; k < 50; k++)
        if (k != 10 && (k < 20 || k > 25)) inspector.add(scanAt(100 * k));
    const Findings found = inspector.findings(inspector.facts());
    ASSERT_THAT(kindsOf(inspector), ElementsAre("lidar_gap"));
    EXPECT_EQ(found[0].t, kStart + 1900 * kMillisecond);
    EXPECT_NEAR(found[0].value, 0.7, 1e-9);
    EXPECT_EQ(found[0].count, 2U);
}

TEST(ALidar, WithHolesBetweenItsSweepsIsFound)
{
    LidarInspector inspector;
    for (int k = 0; k < 50; k++) inspector.add(scanAt(100 * k, 0, 60));
    const Findings found = inspector.findings(inspector.facts());
    ASSERT_THAT(kindsOf(inspector), ElementsAre("lidar_holes"));
    EXPECT_NEAR(found[0].value, 0.04, 1e-9);
}

TEST(ALidar, WhosePointsHaveNoTimesIsFoundOnce)
{
    LidarInspector inspector;
    for (int k = 0; k < 50; k++) inspector.add(scanAt(100 * k, 0, 0));
    const Findings found = inspector.findings(inspector.facts());
    ASSERT_THAT(kindsOf(inspector), ElementsAre("scan_undistorted"));
    EXPECT_EQ(found[0].count, 50U);
}

TEST(ALidar, TellsWhereInTheSweepItsStampIs)
{
    LidarInspector inspector;
    for (int k = 0; k < 50; k++) inspector.add(scanAt(100 * k, -99, 0));
    EXPECT_NEAR(inspector.facts().stamp_at, 1, 1e-9);
    EXPECT_THAT(kindsOf(inspector), IsEmpty());
}

TEST(ALidar, OfOneScanOrNoneIsNoTrouble)
{
    LidarInspector inspector;
    EXPECT_EQ(inspector.facts().scans, 0U);
    EXPECT_THAT(kindsOf(inspector), IsEmpty());
    inspector.add(scanAt(0));
    EXPECT_THAT(kindsOf(inspector), IsEmpty());
    EXPECT_EQ(inspector.facts().rate, 0);
}
}  // namespace
