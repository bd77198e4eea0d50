#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "data_folder.h"
#include "numeric.h"
#include "taut/core/WarningLog.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/rawlog/RawlogWriter.h"

namespace taut::test
{
constexpr Time kStart = 1'700'000'000'000'000'000;
constexpr Duration kMillisecond = 1'000'000;

/** A folder of the running test's own, removed with it. */
class RawlogTest : public testing::Test
{
 protected:
    RawlogTest()
    {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("taut_") + info->test_suite_name() + "_" + info->name() + "_" +
                   std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    ~RawlogTest() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    /** Everything that a source gives. */
    struct Content
    {
        std::vector<Measurement> all;
        ImuSamples imu;
        std::vector<Scan> scans;
        StreamProgress progress;
        WarningLog warnings;
        bool incomplete = false;
    };

    static Content readAll(const RawlogConfig& config)
    {
        Content content;
        RawlogSource source(config, content.warnings.sink());
        while (auto measurement = source.next())
        {
            if (const auto* sample = std::get_if<ImuSample>(&*measurement))
                content.imu.push_back(*sample);
            else
                content.scans.push_back(std::get<Scan>(*measurement));
            content.all.push_back(std::move(*measurement));
        }
        content.progress = source.progress();
        content.incomplete = source.incomplete();
        return content;
    }

    static Content readAll(const std::string& path)
    {
        RawlogConfig config;
        config.path = path;
        return readAll(config);
    }

 private:
    std::filesystem::path folder_;
};

/** At rest, level. */
inline ImuSample restingImu(Time t)
{
    return {t, Vector3d(0, 0, 0.001), Vector3d(0, 0, 9.81)};
}

/** 4 rings of 25 points in 100 ms that differ from scan to scan. */
inline Scan smallScan(Time stamp)
{
    Scan scan;
    scan.stamp = stamp;
    scan.rings = 4;
    for (int i = 0; i < 100; i++)
    {
        const float a = 0.0628f * static_cast<float>(i);
        LidarPoint point;
        point.position = {5 * std::cos(a), 4 * std::sin(a), 0.1f * static_cast<float>(i % 4)};
        point.intensity = static_cast<float>(i);
        point.offset = static_cast<std::int32_t>(i * kMillisecond);
        point.ring = static_cast<std::uint16_t>(i % 4);
        scan.points.push_back(point);
    }
    scan.end = stamp + scan.points.back().offset;
    return scan;
}

/** IMU at 100 Hz and scans at 10 Hz, in the order in which a recorder writes them. */
inline void writeLog(RawlogWriter& writer, int scans, const Pose& T_imu_lidar = {})
{
    for (int k = 0; k < scans; k++)
    {
        const Time stamp = kStart + k * 100 * kMillisecond;
        for (int i = 0; i < 10; i++) writer.write(restingImu(stamp + i * 10 * kMillisecond));
        Scan scan = smallScan(stamp);
        scan.T_imu_lidar = T_imu_lidar;
        writer.write(scan);
    }
}
}  // namespace taut::test
