#include <gmock/gmock.h>

#include <cmath>

#include "numeric.h"
#include "taut/inspection/ImuInspector.h"

namespace
{
using namespace taut;
using testing::ElementsAre;
using testing::IsEmpty;
constexpr Duration kSecond = 1'000'000'000;
constexpr Time kStart = 1'700'000'000 * kSecond;

/** An IMU at rest for 12 s and shaken for 8 s. */
struct MadeUpImu
{
    double rate = 200, rest = 12, duration = 20;
    double gyro_noise = 1e-3, accel_noise = 1e-2;  //!< densities
    double gyro_scale = 1, accel_scale = 1;        //!< units in one of the recording
    double gyro_range = 1e9, accel_range = 1e9;    //!< SI
    double force = 9.81, shake = 2;

    ImuSamples samples() const
    {
        taut::test::Random random(3);
        ImuSamples out;
        for (int i = 0; i < duration * rate; i++)
        {
            const double s = i / rate, u = std::max(0.0, s - rest);
            ImuSample x;
            x.t = kStart + fromSeconds(s);
            x.gyro = random.vector(gyro_noise * std::sqrt(rate));
            x.accel = random.vector(accel_noise * std::sqrt(rate)) + Vector3d(0, 0, force);
            x.gyro += shake * std::sin(6 * u) * Vector3d(1, 0.8, -1.2);
            x.accel += 5 * shake * std::sin(7 * u) * Vector3d(0.3, -0.2, 1);
            x.gyro = gyro_scale * x.gyro.cwiseMax(-gyro_range).cwiseMin(gyro_range);
            x.accel = accel_scale * x.accel.cwiseMax(-accel_range).cwiseMin(accel_range);
            out.push_back(x);
        }
        return out;
    }
};

struct Result
{
    ImuFacts facts;
    Findings findings;
    std::vector<std::string> kinds;
};

Result inspect(
    const ImuSamples& samples, std::optional<bool> degrees = {},
    const ImuNoise& expected = kOrdinaryNoise)
{
    ImuInspector inspector;
    for (const ImuSample& s : samples) inspector.add(s);
    inspector.finish();
    Result r;
    r.facts = inspector.facts(degrees);
    r.findings = inspector.findings(r.facts, expected);
    for (const Finding& f : r.findings) r.kinds.push_back(f.kind);
    return r;
}

TEST(AnImu, WithoutFaultsGivesNoFinding)
{
    const Result r = inspect(MadeUpImu().samples());
    EXPECT_THAT(r.kinds, IsEmpty());
    EXPECT_EQ(r.facts.samples, 4000U);
    EXPECT_NEAR(r.facts.rate, 200, 0.01);
    EXPECT_EQ(r.facts.accel_unit.name, "m/s^2");
    EXPECT_EQ(r.facts.gyro_unit.name, "rad/s");
    EXPECT_NEAR(r.facts.rest, 12, 0.5);
    EXPECT_NEAR(r.facts.noise.gyro, 1e-3, 1e-4);
    EXPECT_NEAR(r.facts.noise.accel, 1e-2, 1e-3);
    EXPECT_NEAR(r.facts.force_at_rest, 9.81, 0.01);
    EXPECT_NEAR(r.facts.max_gyro, 2.4, 0.1);
}

TEST(AnImu, WithGapsTellsTheWorstAndHowMany)
{
    ImuSamples samples = MadeUpImu().samples();
    samples.erase(samples.begin() + 3001, samples.begin() + 3060);
    samples.erase(samples.begin() + 601, samples.begin() + 620);
    const Result r = inspect(samples);
    ASSERT_THAT(r.kinds, ElementsAre("imu_gap"));
    EXPECT_EQ(r.findings[0].t, kStart + 15 * kSecond);
    EXPECT_NEAR(r.findings[0].value, 0.3, 1e-6);
    EXPECT_EQ(r.findings[0].count, 2U);
}

TEST(AnImu, StampedOnArrivalIsUneven)
{
    ImuSamples samples = MadeUpImu().samples();
    for (std::size_t i = 0; i + 1 < samples.size(); i += 4) samples[i].t += 4'500'000;
    EXPECT_THAT(inspect(samples).kinds, ElementsAre("imu_jitter"));
}

TEST(AnImu, ThatIsSlowIsFound)
{
    MadeUpImu imu;
    imu.rate = 25;
    const Result r = inspect(imu.samples());
    ASSERT_THAT(r.kinds, ElementsAre("imu_slow"));
    EXPECT_NEAR(r.findings[0].value, 25, 0.01);
}

TEST(AnImu, InOtherUnitsIsJudgedByGravityAndRestsAllTheSame)
{
    for (const auto& [name, si] : {std::pair{"g", 9.80665}, {"milli-g", 0.00980665}})
    {
        MadeUpImu imu;
        imu.accel_scale = 1 / si;
        const Result r = inspect(imu.samples());
        ASSERT_THAT(r.kinds, ElementsAre("imu_units")) << name;
        EXPECT_EQ(r.findings[0].unit, name);
        EXPECT_THAT(r.findings[0].advice, testing::HasSubstr(std::to_string(si).substr(0, 7)));
        EXPECT_NEAR(r.facts.rest, 12, 0.5);
        EXPECT_NEAR(r.facts.noise.accel, 1e-2, 1e-3);
    }
    MadeUpImu odd;
    odd.accel_scale = 4;
    EXPECT_THAT(inspect(odd.samples()).kinds, testing::Contains("imu_units"));
}

TEST(AnImu, InDegreesIsSeenByItsRatesOrByTheLidar)
{
    MadeUpImu imu;
    imu.gyro_scale = 180 / M_PI;
    const Result fast = inspect(imu.samples());  // up to 140 a second
    ASSERT_THAT(fast.kinds, ElementsAre("imu_units"));
    EXPECT_EQ(fast.facts.gyro_unit.name, "deg/s");
    EXPECT_NEAR(fast.facts.max_gyro, 2.4, 0.1);
    EXPECT_NEAR(fast.facts.noise.gyro, 1e-3, 1e-4);
    imu.shake = 0.3;
    EXPECT_THAT(inspect(imu.samples()).kinds, testing::Not(testing::Contains("imu_units")));
    EXPECT_THAT(inspect(imu.samples(), true).kinds, ElementsAre("imu_units"));
}

TEST(AnImu, ThatClipsIsFoundAxisByAxis)
{
    MadeUpImu imu;
    imu.gyro_range = 2.1816;  // 125 deg/s: x and z reach it
    const Result r = inspect(imu.samples());
    EXPECT_THAT(r.kinds, ElementsAre("gyro_clipped", "gyro_clipped"));
    EXPECT_NEAR(r.findings[0].value, 2.1816, 1e-9);
    EXPECT_GT(r.findings[0].count, 50U);
    imu = {};
    imu.accel_range = 19.0;
    imu.shake = 2.2;
    EXPECT_THAT(inspect(imu.samples()).kinds, ElementsAre("accel_clipped"));
}

TEST(AnImu, WithCoarseValuesAtRestDoesNotClip)
{
    MadeUpImu imu;
    imu.shake = 0;
    ImuSamples samples = imu.samples();
    for (ImuSample& s : samples)
    {
        for (int i = 0; i < 3; i++) s.gyro[i] = 0.02 * std::round(s.gyro[i] / 0.02);
        for (int i = 0; i < 3; i++) s.accel[i] = 0.2 * std::round(s.accel[i] / 0.2);
    }
    const auto kinds = inspect(samples).kinds;
    EXPECT_THAT(kinds, testing::Not(testing::Contains("gyro_clipped")));
    EXPECT_THAT(kinds, testing::Not(testing::Contains("accel_clipped")));
}

TEST(AnImu, WithAShortRestOrNoneIsFound)
{
    MadeUpImu imu;
    imu.rest = 4;
    const Result short_rest = inspect(imu.samples());
    ASSERT_THAT(short_rest.kinds, ElementsAre("short_rest"));
    EXPECT_NEAR(short_rest.findings[0].value, 4, 0.5);
    imu.rest = 0;
    EXPECT_THAT(inspect(imu.samples()).kinds, ElementsAre("no_rest"));
}

TEST(AnImu, ThatIsNoisyIsHeldAgainstWhatIsExpected)
{
    MadeUpImu imu;
    imu.gyro_noise = 3e-3;
    EXPECT_THAT(inspect(imu.samples()).kinds, IsEmpty());
    ImuNoise rig = kOrdinaryNoise;
    rig.gyro = 1e-3;
    const Result r = inspect(imu.samples(), {}, rig);
    ASSERT_THAT(r.kinds, ElementsAre("gyro_noise"));
    EXPECT_NEAR(r.findings[0].value, 3e-3, 3e-4);
    imu = {};
    imu.accel_noise = 0.02;
    rig.accel = 0.009;
    EXPECT_THAT(inspect(imu.samples(), {}, rig).kinds, ElementsAre("accel_noise"));
}

TEST(AnImu, ThatWeighsGravityWronglyIsFound)
{
    MadeUpImu imu;
    imu.force = 10.3;
    const Result r = inspect(imu.samples());
    ASSERT_THAT(r.kinds, ElementsAre("gravity"));
    EXPECT_NEAR(r.findings[0].value, 10.3, 0.01);
}

TEST(AnImu, OfOneSampleOrNoneIsNoTrouble)
{
    EXPECT_EQ(inspect({}).facts.samples, 0U);
    EXPECT_EQ(inspect({{kStart, Vector3d::Zero(), {0, 0, 9.81}}}).facts.rate, 0);
}
}  // namespace
