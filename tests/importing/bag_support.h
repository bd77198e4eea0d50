#pragma once

#include <gmock/gmock.h>

#include "bag_writers.h"
#include "scenes.h"
#include "sqlite3_bag_writer.h"
#include "taut/core/WarningLog.h"
#include "taut/importing/openImportSource.h"
#include "temporary_folder.h"

namespace taut::test
{
constexpr Time kBagStart = 1'700'000'000'123'456'768;  // a multiple of 256 ns, as a double has it
const std::string kLidarTopic = "/ouster/points", kImuTopic = "/ouster/imu";

/** Sweeps of 100 ms without a pause, each other than the one before. */
inline std::vector<Scan> syntheticSweeps(int count, int columns = 60)
{
    SpinningLidar lidar;
    lidar.rings = 4;
    lidar.columns = columns;
    std::vector<Scan> scans;
    for (int k = 0; k < count; k++)
    {
        Scan scan = lidar.scan(Scene{}, 1 + static_cast<unsigned>(k));
        scan.stamp = kBagStart + k * lidar.period;
        for (auto& point : scan.points)
        {
            point.offset -= point.offset % 1000;  // whole microseconds: every field can hold them
            point.intensity = static_cast<float>((point.ring * 7 + k) % 256);
        }
        scan.end = scan.stamp + scan.points.back().offset;
        scans.push_back(scan);
    }
    return scans;
}

/** Readings at 100 Hz over some sweeps. */
inline ImuSamples syntheticReadings(int sweeps, double gravity = 9.81)
{
    ImuSamples samples;
    for (int i = 0; i < 10 * sweeps; i++)
        samples.push_back(
            {kBagStart + i * Duration{10'000'000},
             {0.01 * (i % 7), -0.02, 0.03},
             {0.001 * (i % 5), 0.002, gravity}});
    return samples;
}

/** When a recorder gets a sweep: 5 ms after its last point. */
inline Time arrivalOf(const Scan& scan)
{
    return scan.end + 5'000'000;
}

inline TestMessages sweepMessages(
    const std::vector<Scan>& scans, const CloudStyle& style, TestWire wire)
{
    TestMessages messages;
    for (const Scan& scan : scans)
        messages.push_back(
            {kLidarTopic, "sensor_msgs/PointCloud2", arrivalOf(scan),
             CloudWriter(scan, style, wire).message()});
    return messages;
}

inline TestMessages readingMessages(
    const ImuSamples& samples, TestWire wire, const std::string& frame = "os_lidar")
{
    TestMessages messages;
    for (const ImuSample& sample : samples)
        messages.push_back(
            {kImuTopic, "sensor_msgs/Imu", sample.t + 1'000'000, imuMessage(sample, wire, frame)});
    return messages;
}

/** In the order of arrival. */
inline TestMessages merged(TestMessages a, const TestMessages& b)
{
    a.insert(a.end(), b.begin(), b.end());
    std::stable_sort(
        a.begin(), a.end(),
        [](const TestMessage& x, const TestMessage& y) { return x.received < y.received; });
    return a;
}

/** What an import gave. */
struct Imported
{
    std::vector<Scan> scans;
    ImuSamples readings;
    WarningLog warnings;
    std::string findings;  //!< one a line
    double progress = 0;
};

inline Imported import(const std::string& path, const ImportOptions& options = {})
{
    Imported result;
    const auto source = openImportSource(path, options, result.warnings.sink());
    while (const auto item = source->next())
        if (const auto* scan = std::get_if<Scan>(&*item))
            result.scans.push_back(*scan);
        else
            result.readings.push_back(std::get<ImuSample>(*item));
    result.progress = source->progress();
    for (const auto& line : source->findings()) result.findings += line + "\n";
    return result;
}

/** The text of the error that an import ends with. */
inline std::string failure(const std::string& path, const ImportOptions& options = {})
{
    try
    {
        import(path, options);
    }
    catch (const std::runtime_error& e)
    {
        return e.what();
    }
    return "imported";
}

/** All that was written, with times to a tolerance. */
inline void expectSame(
    const std::vector<Scan>& got, const std::vector<Scan>& want, Duration tolerance)
{
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t k = 0; k < got.size(); k++)
    {
        EXPECT_LE(std::abs(got[k].stamp - want[k].stamp), tolerance);
        EXPECT_LE(std::abs(got[k].end - want[k].end), tolerance);
        EXPECT_FALSE(got[k].already_undistorted);
        ASSERT_EQ(got[k].points.size(), want[k].points.size());
        for (std::size_t i = 0; i < got[k].points.size(); i++)
        {
            const LidarPoint &a = got[k].points[i], &b = want[k].points[i];
            ASSERT_EQ(a.position, b.position);
            ASSERT_EQ(a.intensity, b.intensity);
            ASSERT_EQ(a.ring, b.ring);
            ASSERT_LE(std::abs(got[k].timeOf(a) - want[k].timeOf(b)), tolerance);
        }
    }
}
}  // namespace taut::test
