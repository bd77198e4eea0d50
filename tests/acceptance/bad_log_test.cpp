#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "slam_program.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/rawlog/RawlogWriter.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;
using testing::HasSubstr;

nlohmann::json metricsOf(const std::string& folder)
{
    return nlohmann::json::parse(contentOf(folder + "/metrics.json"));
}

/** The scans of the sample up to a time, without the IMU. */
void writeWithoutImu(const std::string& path, double to_time)
{
    RawlogConfig config;
    config.path = kSample;
    config.to_time = to_time;
    RawlogSource source(config);
    RawlogWriter writer(path);
    while (const auto measurement = source.next())
        if (const Scan* scan = std::get_if<Scan>(&*measurement)) writer.write(*scan);
    writer.close();
}

TEST(ATruncatedLog, GivesThreeAndTheResultsUpToThere)
{
    const TemporaryFolder folder;
    const std::string log = folder / "log.rawlog", out = folder / "out";
    std::filesystem::copy_file(kSample, log);
    std::filesystem::resize_file(log, std::filesystem::file_size(log) * 6 / 10);
    const ProgramRun run = slam(log, out);
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.output, HasSubstr("rawlog_truncated"));
    EXPECT_GT(readTum(out + "/trajectory.tum").size(), 60U);
    EXPECT_LT(readTum(out + "/trajectory.tum").size(), 90U);
    EXPECT_EQ(metricsOf(out)["input"]["incomplete"], true);
}

/** The sample, with IMU samples only up to a time since its start [s]. */
void writeWithDyingImu(const std::string& path, double dies)
{
    RawlogConfig config;
    config.path = kSample;
    RawlogSource source(config);
    RawlogWriter writer(path);
    std::optional<Time> first;
    while (const auto measurement = source.next())
    {
        if (const Scan* scan = std::get_if<Scan>(&*measurement)) writer.write(*scan);
        const ImuSample* sample = std::get_if<ImuSample>(&*measurement);
        if (sample == nullptr) continue;
        if (!first) first = sample->t;
        if (toSeconds(sample->t - *first) < dies) writer.write(*sample);
    }
    writer.close();
}

TEST(AnImuThatDies, GivesThreeAndTheLidarGoesOn)
{
    const TemporaryFolder folder;
    const std::string log = folder / "log.rawlog", out = folder / "out";
    writeWithDyingImu(log, 6);
    const ProgramRun run = slam(log, out, "-s initialization.rest_duration=3");
    EXPECT_EQ(run.exit_code, 3) << run.output;
    EXPECT_THAT(run.output, HasSubstr("imu_silent"));
    const Trajectory whole = readTum(kSampleTruth);
    EXPECT_NEAR(toSeconds(readTum(out + "/trajectory.tum").back().t - whole.back().t), 0, 0.3);
    const auto doubtful = metricsOf(out)["doubtful"];
    ASSERT_FALSE(doubtful.empty());
    EXPECT_EQ(doubtful[0]["cause"], "imu_silent");
    EXPECT_LT(positionError(kSampleTruth, out + "/trajectory.tum"), 0.5);
    EXPECT_LT(metricsOf(out)["memory"]["peak_mb"], 400);
}

TEST(ALogWithoutImu, FallsBackToConstantVelocityAndSaysSo)
{
    const TemporaryFolder folder;
    const std::string log = folder / "log.rawlog", out = folder / "out";
    writeWithoutImu(log, 4.5);
    const ProgramRun run = slam(log, out);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("no_imu"));
    EXPECT_EQ(metricsOf(out)["method"]["with_imu"], false);
    EXPECT_GE(readTum(out + "/trajectory.tum").size(), 40U);
}
}  // namespace
