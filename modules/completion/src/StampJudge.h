#pragma once

#include <optional>
#include <vector>

#include "Panorama.h"
#include "taut/core/Imu.h"

namespace taut
{
/** Tells whether stamps are begins or ends of sweeps by the IMU: how far the view turned from sweep
 * to sweep is what the gyro turned meanwhile, a period later or earlier. How the LiDAR is mounted
 * need not be known. */
class StampJudge
{
 public:
    /** Stamps of two sweeps that follow each other, and what they see. */
    void add(Time first, Time second, const Panorama& of_first, const Panorama& of_second);
    void add(const ImuSample& sample) { samples_.push_back(sample); }

    bool hasSamples() const { return !samples_.empty(); }

    /** True if they are ends, false if begins, with `interval` [ns] from sweep to sweep; nothing if
     * the body turned too little, or the IMU and the view do not agree either way. */
    std::optional<bool> isEnd(Duration interval) const;

 private:
    struct Turned
    {
        Time first, second;  // stamps
        double angle;        // [rad] about the axis of the sensor
    };

    std::optional<Vector3d> gyroAngle(Time middle, Duration half) const;
    /** What remains of how the view turned if it turned as the gyro did. */
    struct Misfit
    {
        double all = 0, rest = 0;  // sums of squares [rad^2]
        int count = 0;
    };
    Misfit misfit(Duration interval, double shift) const;

    std::vector<Turned> turned_;
    ImuSamples samples_;
};
}  // namespace taut
