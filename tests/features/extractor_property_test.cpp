/** \file
 * What every feature extractor must do: add a class name below to hold another one to it. */
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include "scenes.h"
#include "taut/core/FeatureExtractor.h"
#include "taut/core/Plugins.h"
#include "taut/features/Register.h"

using namespace taut;
using namespace taut::test;

namespace
{
using Key = std::tuple<std::int32_t, float, float, float>;
Key keyOf(std::int32_t offset, const Eigen::Vector3f& p)
{
    return {offset, p.x(), p.y(), p.z()};
}

std::vector<std::tuple<Key, FeatureKind>> listOf(const Features& features)
{
    std::vector<std::tuple<Key, FeatureKind>> list;
    for (const Feature& f : features.points) list.emplace_back(keyOf(f.offset, f.position), f.kind);
    return list;
}

Scene furnishedRoom()
{
    Scene scene;
    scene.obstacles = {{{2, 1, -1.2}, {3, 2, 1}}, {{-4, -3, -1.2}, {-3, -1, 0.4}}};
    return scene;
}

class Extractor : public ::testing::TestWithParam<const char*>
{
 protected:
    void SetUp() override { registerFeatureExtractors(); }

    Features extract(const Scan& scan, const std::string& yaml = "{}")
    {
        ConfigSection section(parseYaml(yaml), "features");
        auto extractor = createPlugin<FeatureExtractor>(GetParam());
        extractor->configure(section);
        section.rejectUnknown();
        warnings.clear();
        return extractor->extract(scan, [this](const Warning& w) { warnings.push_back(w); });
    }
    bool warned(const std::string& kind) const
    {
        return std::any_of(
            warnings.begin(), warnings.end(), [&](const Warning& w) { return w.kind == kind; });
    }

    std::vector<Warning> warnings;
};
}  // namespace

TEST_P(Extractor, PicksPointsOfTheScanOnceEachInTheOrderOfTime)
{
    const Scan scan = SpinningLidar{}.scan(furnishedRoom());
    std::set<Key> points, picked;
    for (const LidarPoint& p : scan.points) points.insert(keyOf(p.offset, p.position));

    const Features features = extract(scan);
    EXPECT_EQ(features.stamp, scan.stamp);
    EXPECT_GT(features.points.size(), 300u);
    EXPECT_TRUE(warnings.empty()) << warnings.front().text;
    std::int32_t last = -1;
    for (const Feature& f : features.points)
    {
        EXPECT_GE(f.offset, last);
        last = f.offset;
        EXPECT_TRUE(points.count(keyOf(f.offset, f.position)));
        EXPECT_TRUE(picked.insert(keyOf(f.offset, f.position)).second) << "picked twice";
    }
}

TEST_P(Extractor, DoesNotDependOnTheOrderOfThePoints)
{
    Scan scan = SpinningLidar{}.scan(furnishedRoom());
    const auto first = listOf(extract(scan));
    EXPECT_EQ(first, listOf(extract(scan)));
    std::shuffle(scan.points.begin(), scan.points.end(), std::mt19937(7));
    EXPECT_EQ(first, listOf(extract(scan)));
}

TEST_P(Extractor, KeepsAtMostMaxPoints)
{
    const Scan scan = SpinningLidar{64, 2048, -25, 15}.scan(furnishedRoom());
    const Features features = extract(scan, "max_points: 1000\nmin_points: 100");
    EXPECT_LE(features.points.size(), 1000u);
    EXPECT_GE(features.points.size(), 500u);
}

TEST_P(Extractor, ThinsASparseScanLess)
{
    const Scan scan = SpinningLidar{8, 300}.scan(furnishedRoom());
    const Features features = extract(scan, "min_points: 900");
    EXPECT_GE(features.points.size(), 900u);
    EXPECT_FALSE(warned("sparse_scan"));
}

TEST_P(Extractor, WarnsOfAScanWithFewerPointsThanTheMinimum)
{
    const Scan scan = SpinningLidar{4, 100}.scan(furnishedRoom());
    const Features features = extract(scan, "min_points: 800");
    EXPECT_GT(features.points.size(), 100u);
    ASSERT_TRUE(warned("sparse_scan"));
    EXPECT_EQ(warnings.front().t, scan.end);
}

TEST_P(Extractor, GivesNothingButAWarningForAnEmptyScan)
{
    Scan scan = SpinningLidar{}.scan(furnishedRoom());
    scan.points.clear();
    EXPECT_TRUE(extract(scan).points.empty());
    EXPECT_TRUE(warned("sparse_scan"));
    EXPECT_TRUE(extract(scan, "min_points: 0").points.empty());
    EXPECT_TRUE(warned("sparse_scan"));
}

TEST_P(Extractor, LeavesOutPointsThatAreNotFinite)
{
    Scan scan = SpinningLidar{}.scan(furnishedRoom());
    for (std::size_t i = 0; i < scan.points.size(); i += 3)
        scan.points[i].position[static_cast<int>(i % 9) / 3] =
            i % 2 ? std::numeric_limits<float>::infinity()
                  : std::numeric_limits<float>::quiet_NaN();
    const Features features = extract(scan);
    EXPECT_GT(features.points.size(), 300u);
    for (const Feature& f : features.points) EXPECT_TRUE(f.position.allFinite());
}

TEST_P(Extractor, RejectsAMinimumAboveTheMaximum)
{
    EXPECT_THROW(extract({}, "min_points: 20\nmax_points: 10"), ConfigError);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Extractor, ::testing::Values("taut::CurvatureExtractor", "taut::VoxelThinning"),
    [](const auto& test) { return std::string(test.param).substr(6); });
