/** Times of the points in recordings that do not tell them. */
#include <gmock/gmock.h>

#include <algorithm>
#include <ostream>
#include <random>

#include "recording.h"
#include "taut/completion/SweepCompleter.h"

namespace taut::test
{
namespace
{
using testing::HasSubstr;

constexpr double kMillisecond = 1e6;

enum class Kept
{
    AsMeasured,
    LaserByLaser,
    Shuffled
};

/** How a recording without times came about. */
struct Style
{
    const char* name = "";
    Kept order = Kept::AsMeasured;
    double sense = 1;     //!< +1: the sensor turns counter-clockwise
    double start = -180;  //!< azimuth of the begin [deg]
    double drop = 0;  //!< share of returns that are missing, two thirds of them in its first tenth
    bool rings = true;
};

void PrintTo(const Style& style, std::ostream* out)
{
    *out << style.name;
}

/** Rests for 1.5 s, then moves; once computed. */
const std::vector<Scan>& moving()
{
    static const std::vector<Scan> scans = Recording().scans();
    return scans;
}

/** The recording as its style makes it, with the true times. */
std::vector<Scan> styled(std::vector<Scan> scans, const Style& style)
{
    std::mt19937 engine(3);
    Random random(5);
    const Matrix3d turned = expSO3({0, 0, (style.start + 180) * M_PI / 180});
    for (Scan& scan : scans)
    {
        std::vector<LidarPoint> kept;
        for (const LidarPoint& point : scan.points)
        {
            const bool early =
                point.offset < scan.end - scan.stamp - (scan.end - scan.stamp) * 9 / 10;
            if (random.uniform(0, 1) < (early ? std::min(1.0, 4 * style.drop) : style.drop))
                continue;
            LidarPoint p = point;
            p.position.y() *= static_cast<float>(style.sense);  // a world in a mirror
            p.position = turned.cast<float>() * p.position;
            if (!style.rings) p.ring = 0;
            kept.push_back(p);
        }
        scan.points = std::move(kept);
        if (!style.rings) scan.rings = 0;
        if (style.order == Kept::Shuffled)
            std::shuffle(scan.points.begin(), scan.points.end(), engine);
        if (style.order == Kept::LaserByLaser)
            std::stable_sort(
                scan.points.begin(), scan.points.end(),
                [](const LidarPoint& a, const LidarPoint& b) { return a.ring < b.ring; });
    }
    return scans;
}

/** The times are forgotten, looked for, and given to each sweep. */
struct Told
{
    explicit Told(std::vector<Scan> sweeps, ScanTimes asked = ScanTimes::Auto, bool at_end = false)
        : truth(std::move(sweeps)), scans(truth), completer(asked)
    {
        for (Scan& scan : scans)
        {
            for (LidarPoint& point : scan.points) point.offset = 0;
            if (at_end) scan.stamp = scan.end;
            scan.end = scan.stamp;
            scan.already_undistorted = true;
        }
        for (const Scan& scan : scans)
        {
            learnt++;
            if (!completer.learn(scan)) break;
        }
        completer.finishLearning();
        completer.setStampIsEnd(at_end);
        for (Scan& scan : scans) completer.complete(scan);
    }

    bool told() const { return completer.interval() > 0; }
    std::string finding() const { return completer.findings().back(); }

    /** The error that 99 of 100 points stay below [ms]. */
    double error() const
    {
        std::vector<double> errors;
        for (std::size_t k = 0; k < scans.size(); k++)
            for (std::size_t i = 0; i < scans[k].points.size(); i++)
                errors.push_back(
                    std::abs(static_cast<double>(
                        scans[k].timeOf(scans[k].points[i]) -
                        truth[k].timeOf(truth[k].points[i]))) /
                    kMillisecond);
        std::sort(errors.begin(), errors.end());
        return errors[errors.size() * 99 / 100];
    }

    std::vector<Scan> truth, scans;
    SweepCompleter completer;
    std::size_t learnt = 0;
};

class Sweeps : public testing::TestWithParam<Style>
{
};

/* A column takes 0.4 ms, and motion tells the begin to 2 degrees, 0.6 ms. */
TEST_P(Sweeps, GetTheirTimesBack)
{
    const Told told(styled(moving(), GetParam()));
    ASSERT_TRUE(told.told()) << told.finding();
    EXPECT_LT(told.error(), 1.5) << told.finding();
    EXPECT_THAT(
        told.finding(),
        HasSubstr(
            GetParam().sense > 0 ? ", counter-clockwise from above" : ", clockwise from above"));
    EXPECT_THAT(told.finding(), HasSubstr("a turn of 100.00 ms"));
    for (const Scan& scan : told.scans)
    {
        EXPECT_FALSE(scan.already_undistorted);
        EXPECT_NEAR(toSeconds(scan.end - scan.stamp), 0.1, 0.012);
        for (const LidarPoint& point : scan.points) ASSERT_GE(point.offset, 0);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Styles, Sweeps,
    testing::Values(
        Style{"AsMeasured"}, Style{"AsMeasuredClockwise", Kept::AsMeasured, -1, 0},
        Style{"AsMeasuredWithoutRings", Kept::AsMeasured, -1, 77, 0, false},
        Style{"AsMeasuredWithHoles", Kept::AsMeasured, 1, 123, 0.2},
        Style{"LaserByLaser", Kept::LaserByLaser},
        Style{"LaserByLaserClockwise", Kept::LaserByLaser, -1, 50, 0},
        Style{"LaserByLaserWithoutRings", Kept::LaserByLaser, -1, -20, 0, false},
        Style{"LaserByLaserWithHoles", Kept::LaserByLaser, 1, 10, 0.2},
        Style{"Shuffled", Kept::Shuffled}, Style{"ShuffledClockwise", Kept::Shuffled, -1, 90},
        Style{"ShuffledWithoutRings", Kept::Shuffled, 1, 30, 0.05, false}),
    testing::PrintToStringParamName());

TEST(SweepsWithoutTimes, WhoseLasersWereSortedTheOtherWayGoTheWayThatMotionShows)
{
    auto scans = styled(moving(), {"", Kept::LaserByLaser, -1, 40});
    for (Scan& scan : scans)
    {
        std::reverse(scan.points.begin(), scan.points.end());
        const auto azimuth = [](const LidarPoint& p)
        { return std::atan2(p.position.y(), p.position.x()); };
        std::stable_sort(
            scan.points.begin(), scan.points.end(),
            [&](const LidarPoint& a, const LidarPoint& b)
            { return std::make_pair(a.ring, azimuth(a)) < std::make_pair(b.ring, azimuth(b)); });
    }
    const Told told(std::move(scans));
    ASSERT_TRUE(told.told()) << told.finding();
    EXPECT_LT(told.error(), 1.5) << told.finding();
    EXPECT_THAT(told.finding(), HasSubstr("which motion contradicts"));
}

TEST(SweepsWithoutTimes, ThatAreNoWholeTurnBeginWhereTheLastOneEnded)
{
    // As a driver cuts them that counts packets: a hundredth more than a turn.
    std::vector<LidarPoint> points;
    std::vector<Time> times;
    for (const Scan& scan : moving())
        for (const LidarPoint& point : scan.points)
        {
            points.push_back(point);
            times.push_back(scan.timeOf(point));
        }
    const std::size_t size = moving()[0].points.size() * 101 / 100 / 16 * 16;
    std::vector<Scan> scans;
    for (std::size_t i = 0; i + size <= points.size(); i += size)
    {
        Scan scan = moving()[0];
        scan.stamp = times[i];
        scan.points.assign(points.begin() + i, points.begin() + i + size);
        for (std::size_t k = 0; k < size; k++)
            scan.points[k].offset = static_cast<std::int32_t>(times[i + k] - scan.stamp);
        scan.end = times[i + size - 1];
        scans.push_back(std::move(scan));
    }
    const Told told(std::move(scans));
    ASSERT_TRUE(told.told()) << told.finding();
    EXPECT_LT(told.error(), 0.6);
    EXPECT_THAT(told.finding(), HasSubstr("each sweep from its first point on"));
    EXPECT_THAT(told.finding(), HasSubstr("a turn of 100.0"));
}

TEST(SweepsWithoutTimes, StampedAtTheirEndsBeginAPeriodEarlier)
{
    const Told told(styled(moving(), {}), ScanTimes::Auto, true);
    ASSERT_TRUE(told.told());
    EXPECT_LT(told.error(), 1.5);
}

TEST(SweepsWithoutTimes, HaveStampsThatTheGyroNeverTellsWrongly)
{
    Recording recording;
    recording.swing = 0.6;
    recording.duration = 9;
    for (const bool at_end : {false, true})
    {
        SweepCompleter with_imu, without;
        for (const ImuSample& sample : recording.imu()) with_imu.learn(sample);
        for (Scan scan : recording.scans())
        {
            for (LidarPoint& point : scan.points) point.offset = 0;
            if (at_end) scan.stamp = scan.end;
            scan.already_undistorted = true;
            with_imu.learn(scan);
            without.learn(scan);
        }
        with_imu.finishLearning();
        without.finishLearning();
        EXPECT_GT(without.interval(), 0);
        // That it is told: AnImport.OfCloudsWithoutTimesTakesThemFromTheAzimuth.
        EXPECT_EQ(with_imu.stampIsEnd().value_or(at_end), at_end);
        EXPECT_FALSE(without.stampIsEnd().has_value());
    }
}

/** Lasers that look aside by up to 4 degrees, as an Ouster's do. */
TEST(SweepsWithoutTimes, KnowOfLasersThatLookAside)
{
    auto scans = styled(moving(), {});
    for (Scan& scan : scans)
        for (LidarPoint& point : scan.points)
        {
            const double aside = (point.ring % 4 - 1.5) * 2.8 * M_PI / 180;
            point.position = expSO3({0, 0, aside}).cast<float>() * point.position;
        }
    const Told told(std::move(scans));
    ASSERT_TRUE(told.told());
    EXPECT_LT(told.error(), 0.8);  // 4.2 degrees are 1.2 ms, and a column is 0.4 ms
    EXPECT_THAT(told.finding(), HasSubstr("lasers that look aside"));
}

/** Each point where the sensor would have seen it at the stamp. */
std::vector<Scan> undistorted(std::vector<Scan> scans)
{
    const Recording recording;
    for (Scan& scan : scans)
    {
        const Pose T_sensor_world =
            (recording.truth(scan.stamp).T_world_imu * recording.T_imu_lidar).inverse();
        for (LidarPoint& point : scan.points)
        {
            const Pose then =
                recording.truth(scan.timeOf(point)).T_world_imu * recording.T_imu_lidar;
            const Vector3d world = then * Vector3d(point.position.cast<double>());
            point.position = (T_sensor_world * world).cast<float>();
        }
    }
    return scans;
}

TEST(SweepsWithoutTimes, ThatWereUndistortedStayAsTheyAreUnlessAskedFor)
{
    for (const Kept order : {Kept::AsMeasured, Kept::LaserByLaser, Kept::Shuffled})
    {
        const auto scans = styled(undistorted(moving()), {"", order});
        const Told told(scans);
        EXPECT_FALSE(told.told()) << told.finding();
        EXPECT_TRUE(told.scans[20].already_undistorted);
        EXPECT_THAT(told.finding(), HasSubstr("fit together"));
    }
    EXPECT_TRUE(Told(styled(undistorted(moving()), {}), ScanTimes::Azimuth).told());
}

TEST(SweepsWithoutTimes, OfASensorThatDoesNotTurnStayAsTheyAre)
{
    auto narrow = moving(), scattered = moving();
    Random random(9);
    for (std::size_t k = 0; k < narrow.size(); k++)
    {
        // A view of 80 degrees; and one all around, but in no order, with no begin.
        auto& points = narrow[k].points;
        const auto aside = [](const LidarPoint& p)
        { return std::abs(p.position.y()) > 0.84 * p.position.x(); };
        points.erase(std::remove_if(points.begin(), points.end(), aside), points.end());
        narrow[k].rings = 0;
        const Recording recording;
        scattered[k].rings = 0;
        for (LidarPoint& p : scattered[k].points)
        {
            const Pose sensor =
                recording.truth(scattered[k].timeOf(p)).T_world_imu * recording.T_imu_lidar;
            const Vector3d d = random.vector(1).normalized();
            const double range = Recording::room().seenFrom(sensor.p).range(sensor.R * d);
            p.position = (range * d).cast<float>();
        }
    }
    for (const auto& scans : {narrow, scattered})
    {
        const Told told(scans);
        EXPECT_FALSE(told.told()) << told.finding();
        EXPECT_TRUE(told.scans[30].already_undistorted);
        EXPECT_EQ(told.scans[30].stamp, scans[30].stamp);
    }
}

TEST(SweepsWithoutTimes, StayAsTheyAreIfToldSoOrTooFew)
{
    const Told none(styled(moving(), {}), ScanTimes::None);
    EXPECT_FALSE(none.told());
    EXPECT_EQ(none.learnt, 10U);  // for the rings, if there were none
    EXPECT_THAT(none.finding(), HasSubstr("as asked for"));
    const auto all = styled(moving(), {});
    EXPECT_FALSE(Told({all[0], all[1]}).told());
}

TEST(SweepsWithTimes, AreNotTouched)
{
    SweepCompleter completer;
    EXPECT_FALSE(completer.learn(moving()[0]));
    completer.finishLearning();
    EXPECT_TRUE(completer.findings().empty());
    Scan scan = moving()[20];
    completer.complete(scan);
    for (std::size_t i = 0; i < scan.points.size(); i++)
        ASSERT_EQ(scan.points[i].offset, moving()[20].points[i].offset);
    EXPECT_EQ(scan.stamp, moving()[20].stamp);
}
}  // namespace
}  // namespace taut::test
