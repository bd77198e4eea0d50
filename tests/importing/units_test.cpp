#include <gmock/gmock.h>

#include <cmath>

#include "../../modules/importing/src/CheckedSource.h"
#include "taut/core/WarningLog.h"

namespace taut::test
{
namespace
{
using testing::Contains;
using testing::HasSubstr;

/** What it is given. */
class GivenSource : public ImportSource
{
 public:
    explicit GivenSource(std::vector<ImportedItem> items) : items_(std::move(items)) {}
    std::optional<ImportedItem> next() override
    {
        if (next_ == items_.size()) return {};
        return items_[next_++];
    }
    double progress() const override { return 0; }

 private:
    std::vector<ImportedItem> items_;
    std::size_t next_ = 0;
};

/** 100 Hz; rolls to and fro by 0.3 rad after `rest` seconds. */
std::vector<ImportedItem> samples(
    double rest, double seconds, double accel_unit, double gyro_unit, double bias = 0.002)
{
    std::vector<ImportedItem> items{Scan{}};
    for (int i = 0; i < 100 * seconds; i++)
    {
        const double t = std::max(0.0, 0.01 * i - rest);
        const double roll = 0.3 * std::sin(2 * t), rate = t > 0 ? 0.6 * std::cos(2 * t) : 0;
        ImuSample s;
        s.t = i * 10'000'000LL;
        s.gyro = Vector3d(rate + bias, 0, 0) / gyro_unit;
        s.accel = Vector3d(0, 9.81 * std::sin(roll), 9.81 * std::cos(roll)) / accel_unit;
        items.emplace_back(s);
    }
    return items;
}

struct Outcome
{
    ImuSamples imu;
    std::vector<std::string> findings;
    WarningLog warnings;
};

Outcome check(std::vector<ImportedItem> items, const ImportOptions& options = {})
{
    Outcome outcome;
    CheckedSource source(
        "given", std::make_unique<GivenSource>(std::move(items)), options, outcome.warnings.sink());
    while (const auto item = source.next())
        if (const auto* sample = std::get_if<ImuSample>(&*item)) outcome.imu.push_back(*sample);
    outcome.findings = source.findings();
    return outcome;
}

constexpr double kDegree = M_PI / 180;

TEST(TheUnitsOfAnImu, AreFoundAndConvertedAndSaid)
{
    for (const double accel_unit : {1.0, 9.80665, 9.80665e-3})
        for (const double gyro_unit : {1.0, kDegree})
        {
            const Outcome o = check(samples(0, 4, accel_unit, gyro_unit));
            ASSERT_EQ(o.imu.size(), 400U);
            EXPECT_NEAR(o.imu[50].accel.norm(), 9.81, 1e-9);
            EXPECT_NEAR(o.imu[399].gyro.x(), 0.002 + 0.6 * std::cos(2 * 3.99), 1e-9);
            EXPECT_TRUE(o.warnings.counts().empty());
            const std::string accel = accel_unit == 1  ? "force in m/s^2 ("
                                      : accel_unit > 1 ? "force in g, converted ("
                                                       : "force in milli-g, converted (";
            EXPECT_THAT(o.findings, Contains(HasSubstr(accel)));
            EXPECT_THAT(
                o.findings,
                Contains(HasSubstr(gyro_unit == 1 ? "rates in rad/s (" : "rates in deg/s, conv")));
        }
}

/** 100 Hz; goes to and fro by `force` m/s^2 while it turns, without gravity. */
std::vector<ImportedItem> linearAccelerations(double force)
{
    std::vector<ImportedItem> items{Scan{}};
    for (int i = 0; i < 400; i++)
    {
        const double t = 0.01 * i;
        ImuSample s;
        s.t = i * 10'000'000LL;
        s.gyro = Vector3d(0.3 * std::cos(2 * t), 0.2, 0.5 * std::sin(3 * t));
        s.accel = force * Vector3d(std::sin(9 * t), std::cos(7 * t), 0.5 * std::sin(11 * t + 1));
        items.emplace_back(s);
    }
    return items;
}

TEST(TheUnitsOfAnImu, WithoutGravityAreNotMadeUp)
{
    for (const double force : {0.9, 1.3, 1.7, 2.4})
    {
        const Outcome o = check(linearAccelerations(force));
        EXPECT_NEAR(o.imu[100].accel.x(), force * std::sin(9.0), 1e-9);  // as it was
        ASSERT_EQ(o.warnings.count("imu_units"), 1U) << force;
        EXPECT_THAT(o.warnings.kept().at(0).text, HasSubstr("near gravity in no unit"));
    }
    EXPECT_THAT(
        check(linearAccelerations(0.9)).warnings.kept().at(0).text,
        HasSubstr("as if gravity was taken out"));
    ImportOptions options;
    options.accel_scale = 1.0;
    EXPECT_EQ(check(linearAccelerations(0.9), options).warnings.counts().size(), 0U);
}

TEST(TheUnitsOfAnImu, AreThoseOfAViolentMotionToo)
{
    for (const double unit : {1.0, 9.80665})
    {
        auto items = linearAccelerations(8);
        Matrix3d R = Matrix3d::Identity();
        for (auto& item : items)
            if (auto* s = std::get_if<ImuSample>(&item))
            {
                s->accel = (s->accel + R.transpose() * Vector3d(0, 0, 9.81)) / unit;
                R = R * expSO3(s->gyro * 0.01);
            }
        const Outcome o = check(std::move(items));
        EXPECT_EQ(o.warnings.counts().size(), 0U);
        EXPECT_THAT(
            o.findings,
            Contains(HasSubstr(unit == 1 ? "force in m/s^2 (" : "force in g, converted")));
    }
}

TEST(Clocks, OfSensorsThatWereNotRecordedAtTheSameTimeAreTold)
{
    const auto recorded = [](Duration ahead)
    {
        std::vector<ImportedItem> items;
        for (int i = 0; i < 600; i++)
        {
            ImuSample s;
            s.t = 1'700'000'000'000'000'000 + i * 10'000'000LL;
            s.accel = Vector3d(0, 0, 9.81);
            items.emplace_back(s);
            if (i % 10 != 9) continue;
            Scan scan;
            scan.stamp = scan.end = s.t + ahead;
            items.emplace_back(scan);
        }
        return items;
    };
    EXPECT_EQ(check(recorded(0)).warnings.counts().size(), 0U);
    EXPECT_EQ(check(recorded(2'000'000'000)).warnings.counts().size(), 0U);
    const Outcome o = check(recorded(37'000'000'000));
    ASSERT_EQ(o.warnings.count("clock_offset"), 1U);
    EXPECT_THAT(o.warnings.kept().at(0).text, HasSubstr("clock_offset: -37.0"));
    ImportOptions options;
    options.lidar_clock_offset = -37;
    EXPECT_EQ(check(recorded(37'000'000'000), options).warnings.counts().size(), 0U);
}

TEST(TheUnitsOfAnImu, ThatShowLaterThanTheRestGiveAWarning)
{
    EXPECT_TRUE(check(samples(4, 8, 1, 1, 0)).warnings.counts().empty());
    const auto in_degrees = samples(4, 8, 1, kDegree, 0);
    const Outcome o = check(in_degrees);
    ASSERT_EQ(o.warnings.count("imu_units"), 1U);
    EXPECT_THAT(o.warnings.kept()[0].text, HasSubstr("later ones speak for deg/s"));
    ImportOptions options;
    options.gyro_scale = kDegree;
    const Outcome told = check(in_degrees, options);
    EXPECT_TRUE(told.warnings.counts().empty());
    EXPECT_NEAR(told.imu[400].gyro.norm(), 0, 1e-9);
    EXPECT_NEAR(told.imu[799].gyro.x(), 0.6 * std::cos(2 * 3.99), 1e-9);
}

TEST(TheUnitsOfAnImu, AreNotToldByABiasAtRest)
{
    const Outcome o = check(samples(4, 8, 1, 1, 0.1));  // 5.7 deg/s
    EXPECT_TRUE(o.warnings.counts().empty());
    EXPECT_NEAR(o.imu[0].gyro.x(), 0.1, 1e-9);
}

TEST(TheUnitsOfAnImu, ThatAreNoneGiveAWarning)
{
    const Outcome o = check(samples(4, 8, 0.3, 1));
    EXPECT_EQ(o.warnings.count("imu_units"), 1U);
    EXPECT_NEAR(o.imu[0].accel.norm(), 32.7, 1e-9);
}

TEST(TheUnitsOfAnImu, AreNotJudgedByOneOutlier)
{
    auto items = samples(0, 4, 1, 1);
    std::get<ImuSample>(items[34]).gyro.x() = 200;
    const Outcome o = check(items);
    EXPECT_NEAR(o.imu[0].gyro.x(), 0.002, 1e-9);
    EXPECT_EQ(o.warnings.count("imu_units"), 1U);
}

TEST(ARecordingOfAnImuAlone, IsRefused)
{
    auto items = samples(0, 3, 1, 1);
    items.erase(items.begin());
    EXPECT_THROW(check(items), std::runtime_error);
}

TEST(AnImportedSample, ThatGoesBackOrIsNotFiniteIsLeftOut)
{
    auto items = samples(0, 3, 1, 1);
    std::get<ImuSample>(items[21]).t = std::get<ImuSample>(items[20]).t;
    std::get<ImuSample>(items[31]).accel.x() = std::nan("");
    Scan scan;
    scan.stamp = 7;
    items.insert(items.begin() + 100, {scan, scan});
    const Outcome o = check(items);
    EXPECT_EQ(o.imu.size(), 298U);
    EXPECT_EQ(o.warnings.count("imu_time"), 1U);
    EXPECT_EQ(o.warnings.count("imu_invalid"), 1U);
    EXPECT_EQ(o.warnings.count("scan_time"), 1U);
}

TEST(AnImportedStamp, IsJudgedByThoseAroundIt)
{
    auto items = samples(0, 3, 1, 1);
    std::get<ImuSample>(items[60]).t += 3600'000'000'000;
    std::swap(items[100], items[103]);
    const Outcome o = check(items);
    EXPECT_EQ(o.imu.size(), 299U);
    EXPECT_EQ(o.warnings.count("stamp_outlier"), 1U);
    EXPECT_GE(o.warnings.count("imu_order"), 1U);
    EXPECT_EQ(o.warnings.count("imu_time"), 0U);
}
}  // namespace
}  // namespace taut::test
