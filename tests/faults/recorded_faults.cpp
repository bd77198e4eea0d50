/** What goes wrong in recordings. */
#include <algorithm>
#include <limits>

#include "faults.h"

namespace taut::test
{
namespace
{
constexpr Duration kSecond = 1'000'000'000, kHour = 3600 * kSecond;
constexpr double kMiddle = 7;  // [s] since the first item; in the sample the body moves by then

Time timeOf(const Measurement& item)
{
    const auto* sample = std::get_if<ImuSample>(&item);
    return sample != nullptr ? sample->t : std::get<Scan>(item).stamp;
}

void move(Measurement& item, Duration by)
{
    if (auto* sample = std::get_if<ImuSample>(&item)) sample->t += by;
    if (auto* scan = std::get_if<Scan>(&item))
    {
        scan->stamp += by;
        scan->end += by;
    }
}

/** The first of a kind that is `at` seconds or more from the start. */
template <class Kind>
Items::iterator find(Items& items, double at)
{
    const Time from = timeOf(items.front()) + fromSeconds(at);
    return std::find_if(
        items.begin(), items.end(),
        [&](const Measurement& item)
        { return std::holds_alternative<Kind>(item) && timeOf(item) >= from; });
}

/** Does something with all of a kind from one time to another [s since the start]. */
template <class Kind>
void each(Items& items, double from, double to, const std::function<void(Kind&)>& change)
{
    const Time start = timeOf(items.front());
    for (Measurement& item : items)
    {
        auto* of_kind = std::get_if<Kind>(&item);
        const double at = toSeconds(timeOf(item) - start);
        if (of_kind != nullptr && at >= from && at < to) change(*of_kind);
    }
}

template <class Kind>
void remove(Items& items, double from, double to)
{
    const Time start = timeOf(items.front());
    items.erase(
        std::remove_if(
            items.begin(), items.end(),
            [&](const Measurement& item)
            {
                const double at = toSeconds(timeOf(item) - start);
                return std::holds_alternative<Kind>(item) && at >= from && at < to;
            }),
        items.end());
}

/** Puts the clocks of all sensors by so much, in the order of the file. */
void putClocks(Items& items, Duration by)
{
    for (auto item = find<ImuSample>(items, kMiddle); item != items.end(); ++item) move(*item, by);
}

/** Turns blocks of samples around: up to 0.2 s late. */
void disorder(Items& items)
{
    std::vector<Items::iterator> samples;
    for (auto item = items.begin(); item != items.end(); ++item)
        if (std::holds_alternative<ImuSample>(*item)) samples.push_back(item);
    for (std::size_t i = 200; i + 20 < samples.size(); i += 200)
        for (std::size_t k = 0; k < 10; k++) std::iter_swap(samples[i + k], samples[i + 19 - k]);
}

constexpr double kEnd = 1e9;

std::vector<Fault> all()
{
    std::vector<Fault> faults;
    faults.push_back({"Nothing", "nothing", [](Items&) {}, 0, "", 0.0012});
    faults.push_back(
        {"ASampleInTheFuture", "the stamp of one IMU sample is an hour ahead",
         [](Items& items) { move(*find<ImuSample>(items, kMiddle), kHour); }, 3, "stamp_outlier",
         0.0015});
    faults.push_back(
        {"TheFirstSampleInTheFuture", "the stamp of the first IMU sample is an hour ahead",
         [](Items& items) { move(*find<ImuSample>(items, 0), kHour); }, 3, "stamp_outlier",
         0.0015});
    faults.push_back(
        {"ASampleInThePast", "the stamp of one IMU sample is an hour behind",
         [](Items& items) { move(*find<ImuSample>(items, kMiddle), -kHour); }, 3, "imu_time",
         0.0015});
    faults.push_back(
        {"AScanInTheFuture", "the stamp of one scan is an hour ahead",
         [](Items& items) { move(*find<Scan>(items, kMiddle), kHour); }, 3, "stamp_outlier",
         0.0015});
    faults.push_back(
        {"SamplesOutOfOrder", "IMU samples come up to 0.1 s late in the file", disorder, 0,
         "imu_order", 0.0012});
    faults.push_back(
        {"ClocksSetBackByAnHour", "the clocks of both sensors are set back by an hour",
         [](Items& items) { putClocks(items, -kHour); }, 3, "clock_back", 0.0015});
    faults.push_back(
        {"ClocksSetBackByASecond", "the clocks of both sensors are set back by a second",
         [](Items& items) { putClocks(items, -kSecond); }, 3, "clock_back", 0.0015});
    faults.push_back(
        {"ClocksSetForwardByASecond", "the clocks of both sensors are set forward by a second",
         [](Items& items) { putClocks(items, kSecond); }, 0, "lidar_gap", 0});
    faults.push_back(
        {"AnImpossibleSample", "one IMU sample says 1e6 m/s^2",
         [](Items& items)
         { std::get<ImuSample>(*find<ImuSample>(items, kMiddle)).accel.x() = 1e6; },
         3, "imu_outlier", 0.0015});
    faults.push_back(
        {"AnImpossibleRate", "one IMU sample says 1e4 rad/s",
         [](Items& items) { std::get<ImuSample>(*find<ImuSample>(items, kMiddle)).gyro.x() = 1e4; },
         3, "imu_outlier", 0.0015});
    faults.push_back(
        {"LatePoints", "0.1 % of the points have a time 0.9 s later",
         [](Items& items)
         {
             each<Scan>(
                 items, 0, kEnd,
                 [](Scan& scan)
                 {
                     for (std::size_t i = 500; i < scan.points.size(); i += 1000)
                         scan.points[i].offset += 900'000'000;
                 });
         },
         0, "scan_point_times", 0.0015});
    faults.push_back(
        {"PointsThatAreNotFinite", "a fifth of the points is not finite",
         [](Items& items)
         {
             each<Scan>(
                 items, 0, kEnd,
                 [](Scan& scan)
                 {
                     for (std::size_t i = 0; i < scan.points.size(); i += 5)
                         scan.points[i].position.x() = std::numeric_limits<float>::quiet_NaN();
                 });
         },
         0, "scan_bad_points", 0.002});
    faults.push_back(
        {"SamplesThatAreNotFinite", "every 50th IMU sample is not finite",
         [](Items& items)
         {
             int i = 0;
             each<ImuSample>(
                 items, 0, kEnd,
                 [&i](ImuSample& sample)
                 {
                     if (i++ % 50 == 0) sample.accel.y() = std::numeric_limits<double>::quiet_NaN();
                 });
         },
         3, "imu_invalid", 0.002});
    faults.push_back(
        {"AnEmptyScan", "one scan has no point",
         [](Items& items) { std::get<Scan>(*find<Scan>(items, kMiddle)).points.clear(); }, 3,
         "scan_empty", 0.002});
    faults.push_back(
        {"ARepeatedScan", "one scan comes twice",
         [](Items& items)
         {
             const auto scan = find<Scan>(items, kMiddle);
             const Measurement again = *scan;
             items.insert(scan, again);
         },
         3, "scan_duplicate", 0.0015});
    faults.push_back(
        {"AGapOfTheImu", "no IMU sample for 0.3 s",
         [](Items& items) { remove<ImuSample>(items, kMiddle, kMiddle + 0.3); }, 0, "imu_gap",
         0.01});
    faults.push_back(
        {"AGapOfTheLidar", "no scan for 0.6 s",
         [](Items& items) { remove<Scan>(items, kMiddle, kMiddle + 0.6); }, 0, "lidar_gap", 0.01});
    faults.push_back(
        {"AnImuThatEnds", "no IMU sample after 7 s",
         [](Items& items) { remove<ImuSample>(items, kMiddle, kEnd); }, 3, "imu_silent", 0.3});
    faults.push_back(
        {"ALidarThatEnds", "no scan after 7 s",
         [](Items& items) { remove<Scan>(items, kMiddle, kEnd); }, 3, "lidar_ended", 0.0015, "",
         60});
    faults.push_back(
        {"AnImuThatBeginsLate", "no IMU sample before 7 s",
         [](Items& items) { remove<ImuSample>(items, 0, kMiddle); }, 3, "late_imu", 0.01});
    faults.push_back(
        {"NoImu", "no IMU", [](Items& items) { remove<ImuSample>(items, 0, kEnd); }, 0, "no_imu",
         0.01});
    faults.push_back(
        {"AnImuThatIsNotThere", "no IMU of the log has the label asked for", [](Items&) {}, 3,
         "imu_not_found", 0.01, "--imu NOPE"});
    faults.push_back(
        {"AScanWithALatePoint", "the last point of one scan is 1.8 s late",
         [](Items& items)
         { std::get<Scan>(*find<Scan>(items, kMiddle)).points.back().offset = 1'900'000'000; },
         0, "scan_point_times", 0.0015});
    faults.push_back(
        {"TheClockOfTheLidarSetBack", "the clock of the LiDAR alone is set back by 5 s",
         [](Items& items)
         {
             const Time from = timeOf(*find<Scan>(items, kMiddle));
             for (Measurement& item : items)
                 if (std::holds_alternative<Scan>(item) && timeOf(item) >= from)
                     move(item, -5 * kSecond);
         },
         3, "clock_back", 0.003});
    faults.push_back(
        {"ALidarThatNeverMatches", "the LiDAR sees something else in each scan",
         [](Items& items)
         {
             std::uint32_t state = 1;  // a generator of random numbers (Numerical Recipes)
             const auto random = [&state]
             {
                 state = 1664525u * state + 1013904223u;
                 return 20 * static_cast<float>(state >> 8) / 16777216.0F - 10;
             };
             each<Scan>(
                 items, 0, kEnd,
                 [&](Scan& scan)
                 {
                     for (LidarPoint& p : scan.points) p.position = {random(), random(), random()};
                 });
         },
         3, "few_correspondences", 0});
    return faults;
}
}  // namespace

const std::vector<Fault>& recordedFaults()
{
    static const std::vector<Fault> faults = all();
    return faults;
}
}  // namespace taut::test
