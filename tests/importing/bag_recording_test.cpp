/** A simulated recording goes through a bag and comes back as it was. */
#include "bag_support.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/rawlog/RawlogWriter.h"

namespace taut::test
{
namespace
{
constexpr Duration kTick = 100;  // ns: what a rawlog holds

/** The sample hall while it moves. */
RawlogConfig sampleHall()
{
    RawlogConfig config;
    config.path = TAUT_RAWLOGS "/hall_fast.rawlog";
    config.from_time = 10;
    config.to_time = 12;
    return config;
}

struct Content
{
    std::vector<Scan> scans;
    ImuSamples readings;
};

/** The stamp at the first point: the first beams of a sweep may have hit nothing. */
Scan fromFirstPoint(Scan scan)
{
    const auto first = std::min_element(
        scan.points.begin(), scan.points.end(),
        [](const LidarPoint& a, const LidarPoint& b) { return a.offset < b.offset; });
    const std::int32_t shift = first->offset;
    scan.stamp += shift;
    for (LidarPoint& point : scan.points) point.offset -= shift;
    return scan;
}

Content readRawlog(const RawlogConfig& config)
{
    Content content;
    RawlogSource source(config);
    while (const auto measurement = source.next())
        if (const auto* scan = std::get_if<Scan>(&*measurement))
            content.scans.push_back(fromFirstPoint(*scan));
        else
            content.readings.push_back(std::get<ImuSample>(*measurement));
    return content;
}

void expectSameRecording(const Content& got, const Content& want, Duration tolerance)
{
    expectSame(got.scans, want.scans, tolerance);
    ASSERT_EQ(got.readings.size(), want.readings.size());
    for (std::size_t i = 0; i < want.readings.size(); i++)
    {
        EXPECT_EQ(got.readings[i].t, want.readings[i].t);
        EXPECT_EQ(got.readings[i].accel, want.readings[i].accel);
        EXPECT_EQ(got.readings[i].gyro, want.readings[i].gyro);
    }
}

/** From the rawlog to a bag in a driver's style, imported to a rawlog, and read again. */
Content throughBag(const Content& recording, const CloudStyle& style, const TemporaryFolder& folder)
{
    const auto messages = merged(
        sweepMessages(recording.scans, style, TestWire::Ros1),
        readingMessages(recording.readings, TestWire::Ros1));
    writeFile(folder / "a.bag", Ros1Writer::bag(messages, {"lz4", 20, true}));
    RawlogWriter writer(folder / "a.rawlog");
    const auto source = openImportSource(folder / "a.bag");
    while (const auto item = source->next())
        std::visit([&](const auto& i) { writer.write(i); }, *item);
    writer.close();
    RawlogConfig config;
    config.path = folder / "a.rawlog";
    return readRawlog(config);
}

TEST(ASimulatedRecording, IsTheSameAfterItWasABag)
{
    const TemporaryFolder folder;
    const Content recording = readRawlog(sampleHall());
    ASSERT_GE(recording.scans.size(), 15u);
    expectSameRecording(throughBag(recording, {}, folder), recording, kTick);

    CloudStyle velodyne;
    velodyne.time_name = "time";
    velodyne.time_type = "float32";
    velodyne.time_unit = 1e9;
    velodyne.stamp_at = 1;
    expectSameRecording(throughBag(recording, velodyne, folder), recording, 2 * kTick);

    CloudStyle hesai = velodyne;
    hesai.time_name = "timestamp";
    hesai.time_type = "float64";
    hesai.absolute = true;
    hesai.stamp_at = 0;
    expectSameRecording(throughBag(recording, hesai, folder), recording, 4 * kTick);
}
}  // namespace
}  // namespace taut::test
