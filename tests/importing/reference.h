#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "import_support.h"
#include "scenes.h"
#include "taut/rawlog/RawlogSource.h"

namespace taut::test
{
/** A point with its time, whatever scan it came in. */
struct TimedPoint
{
    Time t = 0;
    Vector3d position = Vector3d::Zero();
    int ring = 0, intensity = 0;
};

/** What a VLP-16 at rest in a room sees in some turns at 10 Hz, and an IMU beside it: points as
 * they are, before any format rounds them. */
struct Reference
{
    explicit Reference(int turns, double first_azimuth = 0)  //!< [deg] of the head, clockwise
    {
        const auto& pattern = velodyne::firingPattern(velodyne::Model::Vlp16);
        const auto& lasers = velodyne::defaultCalibration(velodyne::Model::Vlp16);
        const int count = static_cast<int>(turns * 1e8 / pattern.sequence_period);
        for (int i = 0; i < count; i++)
        {
            const double since = i * pattern.sequence_period;
            azimuths.push_back(std::fmod(first_azimuth + 3600e-9 * since, 360));
            for (int laser = 0; laser < pattern.lasers; laser++)
            {
                const double t = since + laser * pattern.laser_period;
                const double a = (first_azimuth + 3600e-9 * t) * M_PI / 180;
                const double e = lasers[laser].elevation;
                const Vector3d direction(
                    std::cos(e) * std::cos(a), -std::cos(e) * std::sin(a), std::sin(e));
                points.push_back(
                    {kStart + std::llround(t), Scene{}.range(direction) * direction, laser,
                     (i + laser) % 256});
            }
        }
        for (int i = 0; i < 20 * turns; i++)
            imu.push_back(
                {kStart + i * 5 * kMillisecond, Vector3d(0.01, -0.02, 0.03 + 1e-5 * i),
                 Vector3d(0.1, 0.2, 9.8 + 1e-4 * i)});
    }

    /** Turn `k` as a scan: its points are those of 100 ms. */
    Scan turn(int k) const
    {
        const Time begin = kStart + k * 100 * kMillisecond, end = begin + 100 * kMillisecond;
        Scan scan;
        scan.rings = 16;
        for (const TimedPoint& p : points)
        {
            if (p.t < begin || p.t >= end) continue;
            if (scan.points.empty()) scan.stamp = p.t;
            LidarPoint point;
            point.position = p.position.cast<float>();
            point.offset = static_cast<std::int32_t>(p.t - scan.stamp);
            point.ring = static_cast<std::uint16_t>(p.ring);
            point.intensity = static_cast<float>(p.intensity);
            scan.points.push_back(point);
            scan.end = p.t;
        }
        return scan;
    }

    std::vector<TimedPoint> points;
    std::vector<double> azimuths;  //!< of the head, at each firing sequence of 16 points [deg]
    ImuSamples imu;
};

/** A recording turned into a rawlog, as taut-import does, and read as taut-slam does. */
struct ReadBack
{
    std::vector<TimedPoint> points;
    std::vector<Scan> scans;
    ImuSamples imu;
    WarningLog warnings;
    std::vector<std::string> findings;
};

inline ReadBack importAndRead(const std::string& source_path, const std::string& rawlog)
{
    ReadBack back;
    {
        const auto source = openImportSource(source_path, {}, back.warnings.sink());
        RawlogWriter writer(rawlog);
        while (const auto item = source->next())
            std::visit([&writer](const auto& i) { writer.write(i); }, *item);
        writer.close();
        back.findings = source->findings();
    }
    RawlogConfig config;
    config.path = rawlog;
    RawlogSource source(config);
    while (auto measurement = source.next())
    {
        if (const auto* sample = std::get_if<ImuSample>(&*measurement))
        {
            back.imu.push_back(*sample);
            continue;
        }
        const Scan& scan = back.scans.emplace_back(std::move(std::get<Scan>(*measurement)));
        for (const LidarPoint& p : scan.points)
            back.points.push_back(
                {scan.timeOf(p), p.position.cast<double>(), p.ring,
                 static_cast<int>(std::lround(p.intensity))});
    }
    return back;
}

/** The resolution of a format. */
struct Resolution
{
    double position = 1e-6;  //!< [m]
    Duration time = 100;     //!< [ns]: that of rawlogs
    bool rings = true;
};

inline void expectSame(
    const std::vector<TimedPoint>& expected, const std::vector<TimedPoint>& read,
    const Resolution& resolution = {})
{
    ASSERT_EQ(read.size(), expected.size());
    double farthest = 0;
    Duration latest = 0;
    std::size_t other_ring = 0, other_intensity = 0;
    for (std::size_t i = 0; i < read.size(); i++)
    {
        farthest = std::max(farthest, (read[i].position - expected[i].position).norm());
        latest = std::max(latest, std::abs(read[i].t - expected[i].t));
        other_ring += resolution.rings && read[i].ring != expected[i].ring;
        other_intensity += read[i].intensity != expected[i].intensity;
    }
    EXPECT_LE(farthest, resolution.position);
    EXPECT_LE(latest, resolution.time);
    EXPECT_EQ(other_ring, 0U);
    EXPECT_EQ(other_intensity, 0U);
}

inline void expectSame(const ImuSamples& expected, const ImuSamples& read)
{
    ASSERT_EQ(read.size(), expected.size());
    for (std::size_t i = 0; i < read.size(); i++)
    {
        EXPECT_LE(std::abs(read[i].t - expected[i].t), 100);
        EXPECT_LT((read[i].gyro - expected[i].gyro).norm(), 1e-9);
        EXPECT_LT((read[i].accel - expected[i].accel).norm(), 1e-9);
    }
}
}  // namespace taut::test
