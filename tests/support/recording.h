#pragma once

#include <vector>

#include "scenes.h"
#include "taut/core/Imu.h"
#include "taut/core/NavState.h"
#include "taut/core/Scan.h"

namespace taut::test
{
constexpr Duration kSecond = 1'000'000'000;

/** A made-up recording: a body rests in a room with boxes, then moves around in it by hand. */
struct Recording
{
    double rest = 1.5, duration = 5.0;             //!< [s] the motion begins after the rest
    double swing = 1.0;                            //!< of the motion: 1 is brisk, 0 none
    Vector3d turn{0, 0, 0};                        //!< [rad/s] in place, after the rest
    Vector3d drift{0, 0, 0};                       //!< [m/s] steady, from the start: no rest
    double spin = 0;                               //!< [rad/s] about the vertical, the same
    double gyro_noise = 1e-3, accel_noise = 1e-2;  //!< densities
    Vector3d bias_gyro{0.004, -0.003, 0.002};
    Pose T_imu_lidar{expSO3({0.02, -0.01, 1.5}), {0.1, -0.05, 0.15}};
    Duration imu_period = kSecond / 200, scan_period = kSecond / 10;
    int rings = 16, columns = 250;
    double range_noise = 0.01;  //!< [m]
    Time start = 1'700'000'000 * kSecond;

    /** True pose of the body; the world is that of its first pose, level and without yaw. */
    Pose pose(double s) const
    {
        // Starts smoothly: acceleration included.
        const double u = s > rest ? s - rest - std::tanh(2 * (s - rest)) / 2 : 0.0;
        const Vector3d p(
            1.2 * std::sin(1.9 * u), 0.8 * (1 - std::cos(2.3 * u)), 0.3 * std::sin(2.9 * u));
        const Vector3d swung(
            0.25 * std::sin(2.7 * u), 0.2 * std::sin(3.1 * u), 0.9 * std::sin(1.7 * u));
        const Matrix3d level = expSO3({0, -0.03, 0}) * expSO3({0.05, 0, 0});
        const Matrix3d spun = expSO3({0, 0, s * spin});
        return {spun * level * expSO3(swing * swung + u * turn), swing * p + s * drift};
    }

    NavState truth(Time t) const
    {
        constexpr double h = 1e-4;
        const double s = toSeconds(t - start);
        NavState x;
        x.t = t;
        x.T_world_imu = pose(s);
        x.v_world = (pose(s + h).p - pose(s - h).p) / (2 * h);
        x.bias_gyro = bias_gyro;
        return x;
    }

    ImuSample exactSample(Time t) const
    {
        constexpr double h = 5e-4;
        const double s = toSeconds(t - start);
        const Pose before = pose(s - h), at = pose(s), after = pose(s + h);
        const Vector3d acceleration = (after.p - 2 * at.p + before.p) / (h * h);
        return {
            t, logSO3(before.R.transpose() * after.R) / (2 * h) + bias_gyro,
            at.R.transpose() * (acceleration + kGravityWorld)};
    }

    ImuSamples imu() const
    {
        Random random(11);
        const double root = std::sqrt(toSeconds(imu_period));
        ImuSamples out;
        for (Time t = start; t <= start + fromSeconds(duration) + imu_period; t += imu_period)
        {
            out.push_back(exactSample(t));
            out.back().gyro += random.vector(gyro_noise / root);
            out.back().accel += random.vector(accel_noise / root);
        }
        return out;
    }

    static Scene room()
    {
        Scene scene;
        scene.room = {{-5, -4, -1.3}, {6, 5, 2.2}};
        scene.obstacles = {
            {{2.5, -3.5, -1.3}, {3.5, -2, 0.8}},
            {{-4.5, 2.5, -1.3}, {-3, 4, 1.5}},
            {{4, 3, -1.3}, {5, 4, 0.3}}};
        return scene;
    }

    /** The scan that begins at time t. */
    Scan scan(Time t) const
    {
        SpinningLidar lidar;
        lidar.rings = rings;
        lidar.columns = columns;
        lidar.lowest = -25;
        lidar.highest = 20;
        Random random(static_cast<unsigned>((t - start) / 1000));
        Scan out;
        out.stamp = t;
        out.end = t + scan_period;
        out.rings = rings;
        out.T_imu_lidar = T_imu_lidar;
        for (int column = 0; column < columns; column++)
        {
            LidarPoint p;
            p.offset = static_cast<std::int32_t>(scan_period * (column + 1) / columns);
            const Pose sensor = pose(toSeconds(t + p.offset - start)) * T_imu_lidar;
            const Scene seen = room().seenFrom(sensor.p);
            for (int ring = 0; ring < rings; ring++)
            {
                const Vector3d d = lidar.direction(ring, column);
                const double range = seen.range(sensor.R * d) + range_noise * random.normal();
                p.position = (range * d).cast<float>();
                p.ring = static_cast<std::uint16_t>(ring);
                out.points.push_back(p);
            }
        }
        return out;
    }

    std::vector<Scan> scans() const
    {
        std::vector<Scan> out;
        for (Time t = start; t + scan_period <= start + fromSeconds(duration); t += scan_period)
            out.push_back(scan(t));
        return out;
    }
};
}  // namespace taut::test
