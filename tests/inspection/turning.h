#pragma once

#include "numeric.h"
#include "taut/inspection/GyroRotation.h"
#include "taut/inspection/RotationAlignment.h"

namespace taut::test
{
constexpr Duration kSecond = 1'000'000'000;
constexpr Time kEpoch = 1'700'000'000 * kSecond;

/** A body that turns to and fro, known in closed form, and what a gyro and a LiDAR say of it. */
struct Turning
{
    Vector3d swing{0.5, 0.4, 0.9};  //!< [rad] about each axis
    double clock_offset = 0;        //!< [s] of the gyro's stamps against the LiDAR's
    Matrix3d R_imu_lidar = expSO3({0.02, -0.01, 1.5});
    Vector3d bias = Vector3d::Zero();
    double gyro_noise = 0;   //!< [rad/s] of a sample
    double lidar_noise = 0;  //!< [rad] of a pose
    double duration = 20;    //!< [s]
    unsigned seed = 1;

    /** Rotation of the body. */
    Matrix3d at(double s) const
    {
        const Vector3d phase(std::sin(1.7 * s), std::sin(2.3 * s + 1), std::sin(1.1 * s + 2));
        return expSO3(swing.cwiseProduct(phase));
    }

    ImuSamples gyro() const
    {
        Random random(seed);
        ImuSamples samples;
        for (double s = 0; s < duration; s += 0.005)
        {
            constexpr double h = 1e-4;
            ImuSample sample;
            sample.t = kEpoch + fromSeconds(s + clock_offset);
            sample.gyro = logSO3(at(s - h).transpose() * at(s + h)) / (2 * h) + bias +
                          random.vector(gyro_noise);
            samples.push_back(sample);
        }
        return samples;
    }

    LidarTurns lidar() const
    {
        Random random(seed + 1000);
        LidarTurns turns;
        Matrix3d last = at(0) * R_imu_lidar;
        for (int k = 1; k * 0.1 < duration; k++)
        {
            const Matrix3d R = at(k * 0.1) * R_imu_lidar * expSO3(random.vector(lidar_noise));
            turns.push_back(
                {kEpoch + fromSeconds((k - 1) * 0.1), kEpoch + fromSeconds(k * 0.1),
                 logSO3(last.transpose() * R)});
            last = R;
        }
        return turns;
    }
};
}  // namespace taut::test
