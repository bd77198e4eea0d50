#include "taut/core/Beams.h"

#include "taut/core/Yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "taut/rawlog/Rig.h"

using namespace taut;
using ::testing::HasSubstr;

TEST(ABeam, MovesItsPointAsItsDerivativeSays)
{
    for (const Vector3d& p : {Vector3d(3, 4, 2), Vector3d(-7, 1, -3), Vector3d(0.5, -20, 0)})
    {
        constexpr double h = 1e-6;
        const BeamDerivative d = beamDerivative(p);
        const Vector3d by_range = (withBeamChanged(p, 0, h) - withBeamChanged(p, 0, -h)) / (2 * h);
        const Vector3d by_elevation =
            (withBeamChanged(p, h, 0) - withBeamChanged(p, -h, 0)) / (2 * h);
        EXPECT_LT((d.by_range - by_range).norm(), 1e-8);
        EXPECT_LT((d.by_elevation - by_elevation).norm(), 1e-7);
    }
}

TEST(ABeam, KeepsItsAzimuthAndTurnsByItsElevation)
{
    const Vector3d p(3, 4, 2);
    const Vector3d moved = withBeamChanged(p, 0.01, 0.5);
    EXPECT_NEAR(moved.norm(), p.norm() + 0.5, 1e-12);
    EXPECT_NEAR(std::atan2(moved.y(), moved.x()), std::atan2(p.y(), p.x()), 1e-12);
    EXPECT_NEAR(std::asin(moved.z() / moved.norm()), std::asin(p.z() / p.norm()) + 0.01, 1e-12);
}

TEST(BeamsOfARig, AreReadAndApplied)
{
    const Rig rig = parseRig("lidar: {beams: {elevation: [0.5, -1], range: [0.1, 0.2]}}");
    Scan scan;
    scan.rings = 2;
    scan.points.resize(1);
    scan.points[0].ring = 1;
    scan.points[0].position = {10, 0, 0};
    correctBeams(scan, rig.lidar.beams);
    EXPECT_NEAR(scan.points[0].position.x(), 10.2 * std::cos(M_PI / 180), 1e-5);
    EXPECT_NEAR(scan.points[0].position.z(), -10.2 * std::sin(M_PI / 180), 1e-5);
    scan.rings = 3;
    EXPECT_THROW(correctBeams(scan, rig.lidar.beams), std::runtime_error);
    const Rig ranges = parseRig("lidar: {beams: {range: [0.1, 0.2]}}");
    EXPECT_EQ(ranges.lidar.beams.elevation.size(), 2u);
}

TEST(BeamsOfARig, ThatDoNotFitAreRefusedWithTheirKey)
{
    for (const auto& [text, cause] : std::vector<std::pair<std::string, std::string>>{
             {"lidar: {beams: {elevation: [1, 2], range: [1]}}", "lidar.beams"},
             {"lidar: {beams: {elevation: 3}}", "not a list"},
             {"lidar: {beams: {elevation: [a]}}", "not a number"},
             {"lidar: {beams: {elevation: [99]}}", "outside"}})
    {
        try
        {
            parseRig(text);
            FAIL() << text;
        }
        catch (const ConfigError& e)
        {
            EXPECT_THAT(e.what(), HasSubstr(cause)) << text;
        }
    }
}
