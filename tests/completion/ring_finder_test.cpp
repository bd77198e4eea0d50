/** Rings of recordings that do not tell them. */
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <ostream>
#include <random>

#include "scenes.h"
#include "taut/completion/RingFinder.h"

namespace taut::test
{
namespace
{
using testing::HasSubstr;

constexpr double kDegree = M_PI / 180;

/** As KITTI has the sweeps of an HDL-64E: two blocks of lasers above each other, one laser after
 * the other from the highest to the lowest, each from azimuth `seam` on. The rings are those that
 * the recording does not have. */
Scan laserByLaser(double seam, double sense, unsigned seed, double elevation_noise = 0)
{
    constexpr int kColumns = 400;
    Random random(seed);
    const Scene scene{{{-30, -12, -1.7}, {50, 15, 9}}, {{{5, -4, -1.7}, {9, -2, 0.2}}}};
    Scan scan;
    for (int laser = 0; laser < 64; laser++)
    {
        const bool upper = laser < 32;
        const double up = kDegree * (upper ? 2 - laser / 3.0 : -8.83 - (laser - 32) / 2.0) +
                          elevation_noise * random.normal();
        const Vector3d origin(0, 0, upper ? 0.21 : 0.13);
        for (int column = 0; column < kColumns; column++)
        {
            if (random.uniform(0, 1) < 0.1) continue;  // no return
            const double azimuth = seam + sense * 2 * M_PI * (column + 0.5) / kColumns;
            const double e = up + elevation_noise * random.normal();
            const Vector3d d(
                std::cos(e) * std::cos(azimuth), std::cos(e) * std::sin(azimuth), std::sin(e));
            const double range = scene.seenFrom(origin).range(d) + 0.02 * random.normal();
            LidarPoint point;
            point.position = (origin + range * d).cast<float>();
            point.ring = static_cast<std::uint16_t>(laser);
            scan.points.push_back(point);
        }
    }
    return scan;
}

/** Rings are forgotten, looked for, and given to each sweep. */
struct Found
{
    explicit Found(std::vector<Scan> sweeps) : truth(std::move(sweeps)), scans(truth)
    {
        std::vector<const Scan*> learnt;
        for (Scan& scan : scans)
        {
            scan.rings = 0;
            for (LidarPoint& point : scan.points) point.ring = 0;
            learnt.push_back(&scan);
        }
        told = finder.learn(learnt);
        for (Scan& scan : scans) finder.apply(scan);
    }

    /** Share of points on another ring than the true one. */
    double wrong(const std::function<int(int)>& ring_of_laser) const
    {
        std::size_t count = 0, all = 0;
        for (std::size_t k = 0; k < scans.size(); k++)
            for (std::size_t i = 0; i < scans[k].points.size(); i++)
            {
                all++;
                if (scans[k].points[i].ring != ring_of_laser(truth[k].points[i].ring)) count++;
            }
        return static_cast<double>(count) / static_cast<double>(all);
    }

    std::vector<Scan> truth, scans;
    RingFinder finder;
    bool told = false;
};

int same(int laser)
{
    return laser;
}

/** A VLP-16 or the like has its highest laser last here. */
int fromBelow(int laser)
{
    return 15 - laser;
}

struct Order
{
    const char* name;
    double seam, sense;
};

void PrintTo(const Order& order, std::ostream* out)
{
    *out << order.name;
}

class ASweepOfOneLaserAfterTheOther : public testing::TestWithParam<Order>
{
};

TEST_P(ASweepOfOneLaserAfterTheOther, TellsItsRings)
{
    const Found found(
        {laserByLaser(GetParam().seam, GetParam().sense, 1),
         laserByLaser(GetParam().seam, GetParam().sense, 2)});
    ASSERT_TRUE(found.told) << found.finder.finding();
    EXPECT_EQ(found.scans[0].rings, 64);
    EXPECT_LT(found.wrong(same), 1e-3);
    EXPECT_THAT(found.finder.finding(), HasSubstr("64, told from the order"));
    EXPECT_NEAR(std::atan(found.finder.beams()[3].slope), kDegree, 0.01 * kDegree);
    EXPECT_NEAR(found.finder.beams()[3].height, 0.21, 0.01);
    EXPECT_NEAR(found.finder.beams()[40].height, 0.13, 0.01);
}

INSTANTIATE_TEST_SUITE_P(
    Orders, ASweepOfOneLaserAfterTheOther,
    testing::Values(
        Order{"FromTheFront", 0, 1}, Order{"FromTheBack", M_PI, 1}, Order{"Clockwise", 0, -1},
        Order{"FromSomewhere", 0.7, -1}),
    testing::PrintToStringParamName());

TEST(RingFinder, NumbersTheOthersRightWhereALaserSeesNothing)
{
    std::vector<Scan> sweeps;
    for (unsigned seed = 1; seed <= 5; seed++) sweeps.push_back(laserByLaser(0, 1, seed));
    auto& points = sweeps[3].points;
    const auto sees_nothing = [](const LidarPoint& p) { return p.ring == 0 || p.ring == 20; };
    points.erase(std::remove_if(points.begin(), points.end(), sees_nothing), points.end());
    const Found found(std::move(sweeps));
    ASSERT_TRUE(found.told) << found.finder.finding();
    EXPECT_EQ(found.scans[3].rings, 64);
    EXPECT_LT(found.wrong(same), 1e-3);
}

TEST(RingFinder, TellsRingsByElevationWhateverTheOrder)
{
    for (const bool shuffled : {false, true})
    {
        Scan sweep = SpinningLidar{}.scan(Scene{});
        if (shuffled) std::shuffle(sweep.points.begin(), sweep.points.end(), std::mt19937(1));
        const Found found({sweep});
        ASSERT_TRUE(found.told) << found.finder.finding();
        EXPECT_EQ(found.scans[0].rings, 16);
        EXPECT_EQ(found.wrong(fromBelow), 0);
        EXPECT_THAT(found.finder.finding(), HasSubstr("16, told from the elevations"));
    }
}

/** Points all over a cone around the x axis, or all over the sphere. */
Scan anywhere(double half_angle)
{
    Random random(7);
    Scan scan;
    while (scan.points.size() < 20000)
    {
        const Vector3d d = random.vector(1).normalized();
        if (std::acos(d.x()) > half_angle) continue;
        LidarPoint point;
        point.position = (Scene{}.range(d) * d).cast<float>();
        scan.points.push_back(point);
    }
    return scan;
}

TEST(RingFinder, TellsNothingOfASensorWithoutRings)
{
    for (const double half_angle : {0.6, M_PI})
    {
        const Found found({anywhere(half_angle), anywhere(half_angle)});
        EXPECT_FALSE(found.told);
        EXPECT_EQ(found.scans[0].rings, 0);
        EXPECT_TRUE(found.finder.beams().empty());
        EXPECT_THAT(found.finder.finding(), HasSubstr("rings: none ("));
    }
}

TEST(RingFinder, TellsNothingWherePointsAreOffTheirLasers)
{
    const Found found({laserByLaser(0, 1, 1, 0.2 * kDegree)});
    EXPECT_FALSE(found.told) << found.finder.finding();
    EXPECT_THAT(found.finder.finding(), HasSubstr("of the points fit"));
}

TEST(RingFinder, TellsNothingOfASweepWithoutPoints)
{
    EXPECT_FALSE(Found({Scan{}}).told);
    EXPECT_FALSE(Found(std::vector<Scan>{}).told);
}
}  // namespace
}  // namespace taut::test
