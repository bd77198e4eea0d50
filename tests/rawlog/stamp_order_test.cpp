#include "taut/rawlog/StampOrder.h"

#include <gtest/gtest.h>

#include <utility>

using namespace taut;

namespace
{
using Sensor = StampOrder::Sensor;
using Verdict = StampOrder::Verdict;
constexpr Duration kMillisecond = 1'000'000, kSecond = 1000 * kMillisecond;

struct Given
{
    Sensor sensor;
    Time t;
};

/** An IMU at 100 Hz and a LiDAR at 10 Hz for some seconds. */
std::vector<Given> usual(double seconds)
{
    std::vector<Given> given;
    for (Time t = 0; t < fromSeconds(seconds); t += 10 * kMillisecond)
    {
        given.push_back({Sensor::Imu, kSecond + t});
        if (t % (100 * kMillisecond) == 90 * kMillisecond)
            given.push_back({Sensor::Lidar, kSecond + t - 85 * kMillisecond});
    }
    return given;
}

struct Result
{
    std::vector<StampOrder::Judged> judged;
    std::vector<Time> imu, lidar;  // as they are to be used
    std::size_t count(Verdict verdict) const
    {
        std::size_t n = 0;
        for (const auto& j : judged) n += j.verdict == verdict ? 1 : 0;
        return n;
    }
};

Result judge(const std::vector<Given>& given, StampOrder::Judge how = StampOrder::Judge::Later)
{
    StampOrder order(how);
    Result result;
    const auto take = [&](const StampOrder::Judged& judged)
    {
        result.judged.push_back(judged);
        const Given& g = given[judged.id];
        if (judged.verdict != Verdict::Outlier)
            (g.sensor == Sensor::Imu ? result.imu : result.lidar).push_back(g.t + judged.shift);
    };
    for (const Given& g : given)
    {
        order.push(g.sensor, g.t);
        while (order.ready()) take(*order.pop());
    }
    while (const auto judged = order.pop()) take(*judged);
    return result;
}

void expectIncreasing(const std::vector<Time>& times)
{
    for (std::size_t i = 1; i < times.size(); i++) EXPECT_GT(times[i], times[i - 1]) << i;
}

std::size_t nth(const std::vector<Given>& given, Sensor sensor, std::size_t n)
{
    for (std::size_t i = 0; i < given.size(); i++)
        if (given[i].sensor == sensor && n-- == 0) return i;
    return given.size();
}
}  // namespace

TEST(TheOrderOfStamps, ChangesNothingWhileAllIsWell)
{
    const auto given = usual(5);
    const Result result = judge(given);
    ASSERT_EQ(result.judged.size(), given.size());
    for (std::size_t i = 0; i < given.size(); i++)
    {
        EXPECT_EQ(result.judged[i].id, i);
        EXPECT_EQ(result.judged[i].verdict, Verdict::Good);
        EXPECT_EQ(result.judged[i].shift, 0);
    }
}

TEST(TheOrderOfStamps, ChangesNothingInGapsOrWhereASensorEnds)
{
    auto given = usual(8);
    given.erase(given.begin() + 200, given.begin() + 500);  // both, longer than the look ahead
    for (std::size_t i = 400; i < given.size();)            // no IMU from here on
        given[i].sensor == Sensor::Imu ? void(given.erase(given.begin() + i)) : void(i++);
    const Result result = judge(given);
    ASSERT_EQ(result.judged.size(), given.size());
    for (std::size_t i = 0; i < given.size(); i++) EXPECT_EQ(result.judged[i].id, i);
    EXPECT_EQ(result.count(Verdict::Good), given.size());
}

TEST(TheOrderOfStamps, LeavesOutWhatIsFarFromItsNeighboursAlone)
{
    for (const Sensor sensor : {Sensor::Imu, Sensor::Lidar})
        for (const Duration by : {3600 * kSecond, 2 * kSecond})
            for (const std::size_t n : {0, 1, 20, 40})
            {
                auto given = usual(5);
                const std::size_t at = nth(given, sensor, n);
                given[at].t += by;
                const Result result = judge(given);
                EXPECT_EQ(result.count(Verdict::Outlier), 1u) << n;
                EXPECT_EQ(result.count(Verdict::Good), given.size() - 1) << n;
                expectIncreasing(result.imu);
                expectIncreasing(result.lidar);
            }
}

TEST(TheOrderOfStamps, LeavesOutSomeInARowToo)
{
    auto given = usual(5);
    for (std::size_t n = 100; n < 120; n++) given[nth(given, Sensor::Imu, n)].t += 3600 * kSecond;
    const Result result = judge(given);
    EXPECT_EQ(result.count(Verdict::Outlier), 20u);
    EXPECT_EQ(result.count(Verdict::SetBack), 0u);
    expectIncreasing(result.imu);
}

TEST(TheOrderOfStamps, SortsSamplesUpToASecondLate)
{
    auto given = usual(5);
    const std::vector<Given> block(given.begin() + 100, given.begin() + 140);
    given.erase(given.begin() + 100, given.begin() + 140);
    given.insert(given.begin() + 160, block.begin(), block.end());  // 0.9 s late
    const Result result = judge(given);
    EXPECT_GT(result.count(Verdict::Sorted), 30u);
    EXPECT_EQ(result.count(Verdict::SetBack), 0u);
    EXPECT_EQ(result.imu.size(), 500u);
    expectIncreasing(result.imu);
}

TEST(TheOrderOfStamps, FollowsAClockThatIsSetBack)
{
    for (const Duration by : {3600 * kSecond, 2 * kSecond, kSecond, 3 * kSecond / 5})
    {
        auto given = usual(8);
        const auto whole = judge(given);
        for (std::size_t i = 300; i < given.size(); i++) given[i].t -= by;
        const Result result = judge(given);
        EXPECT_EQ(result.count(Verdict::SetBack), 2u) << toSeconds(by);
        EXPECT_EQ(result.imu, whole.imu) << toSeconds(by);
        EXPECT_EQ(result.lidar, whole.lidar) << toSeconds(by);
    }
}

TEST(TheOrderOfStamps, MovesBothSensorsByTheSame)
{
    auto given = usual(8);
    for (std::size_t i = 300; i < given.size(); i++) given[i].t -= 60 * kSecond;
    given.erase(given.begin() + 300, given.begin() + 325);  // what came meanwhile is lost
    const Result result = judge(given);
    EXPECT_EQ(result.count(Verdict::SetBack), 2u);
    EXPECT_EQ(result.judged.back().shift, result.judged[result.judged.size() - 2].shift);
    expectIncreasing(result.imu);
    expectIncreasing(result.lidar);
}

TEST(TheOrderOfStamps, FollowsTheClockOfOneSensorAlone)
{
    auto given = usual(8);
    const auto whole = judge(given);
    for (std::size_t i = 300; i < given.size(); i++)
        if (given[i].sensor == Sensor::Lidar) given[i].t -= 5 * kSecond;
    const Result result = judge(given);
    EXPECT_EQ(result.count(Verdict::SetBack), 1u);
    EXPECT_EQ(result.imu, whole.imu);
    EXPECT_EQ(result.lidar, whole.lidar);
}

TEST(TheOrderOfStamps, DoesNotFollowAForwardJump)
{
    auto given = usual(8);
    for (std::size_t i = 300; i < given.size(); i++) given[i].t += 3600 * kSecond;
    const Result result = judge(given);
    EXPECT_EQ(result.count(Verdict::Good), given.size());
    EXPECT_EQ(result.judged.back().shift, 0);
}

TEST(TheOrderOfStamps, LooksAheadNoFurtherThanItMust)
{
    StampOrder order;
    std::size_t most = 0, held = 0;
    for (const Given& g : usual(20))
    {
        order.push(g.sensor, g.t);
        held++;
        while (order.ready() && order.pop()) held--;
        most = std::max(most, held);
    }
    EXPECT_LE(most, 115u);  // a second of both
}

TEST(StampOrder, JudgedAtOnceGoodStampsAreGivenAsTheyCome)
{
    const auto given = usual(5);
    StampOrder order(StampOrder::Judge::AtOnce);
    std::size_t taken = 0;
    for (std::size_t i = 0; i < given.size(); i++)
    {
        order.push(given[i].sensor, given[i].t);
        while (order.ready()) EXPECT_EQ(order.pop()->id, taken++);
        if (i > 230)  // a second, two of the LiDAR, have been seen
        {
            EXPECT_EQ(taken, i + 1);
        }
    }
}

TEST(StampOrder, JudgedAtOnceAFaultIsStillJudgedByWhatFollows)
{
    auto given = usual(8);
    given[400].t += 50 * kSecond;
    for (std::size_t i = 600; i < given.size(); i++) given[i].t -= 3 * kSecond;
    const Result later = judge(given), at_once = judge(given, StampOrder::Judge::AtOnce);
    EXPECT_EQ(at_once.count(Verdict::Outlier), 1u);
    EXPECT_EQ(at_once.count(Verdict::SetBack), 2u);
    EXPECT_EQ(at_once.imu, later.imu);
    EXPECT_EQ(at_once.lidar, later.lidar);
}
