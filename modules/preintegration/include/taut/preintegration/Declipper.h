#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>

#include "taut/core/Config.h"
#include "taut/core/Imu.h"
#include "taut/core/Warning.h"

namespace taut
{
/** What an IMU can measure. */
struct ImuRange
{
    double gyro = 0;   //!< [rad/s]; 0: told from readings that repeat their extreme
    double accel = 0;  //!< [m/s^2]; the same

    void declare(ConfigSection& section);
};

/** Finds samples at the end of the sensor's range and puts what they hide in place of the readings.
 *
 * A reading at the limit says only that the truth lies beyond it. How the signal comes to the limit
 * and how it leaves it tell more: a cubic with the values and slopes of both sides (Hermite
 * interpolation) is put through the clipped stretch, and the samples carry the standard deviation
 * of what it may miss (ImuSample::gyro_hidden, accel_hidden). Samples of a stretch are held back
 * until it has ended, or for kLongest at most. Other samples pass through unchanged.
 *
 * Not thread-safe. */
class Declipper
{
 public:
    static constexpr double kLongest = 0.5;  //!< [s] for which a stretch may hold samples back

    explicit Declipper(const ImuRange& range = {}, WarningSink warn = {});

    /** Takes a sample, later than all before; gives those that are complete, in order. */
    ImuSamples add(const ImuSample& sample);

    /** No more samples: gives those that were held back. */
    ImuSamples finish();

    /** Samples that were at the limit of an axis of the gyro or of the accelerometer. */
    std::size_t clipped() const { return clipped_; }

 private:
    static constexpr std::size_t kAxes = 6;  // gyro x, y, z, accelerometer x, y, z

    /** Samples at one end of an axis, by their numbers; a few between them may be below. */
    struct Stretch
    {
        std::size_t first = 0, last = 0;
    };
    struct Axis
    {
        std::optional<double> limit;  // magnitude
        bool configured = false;
        double largest = 0, previous = 0;  // magnitude; value
        int run = 0;                       // readings in a row that are equal
        std::optional<Stretch> open;
        std::size_t free_from = 0;   // number of the first sample after the stretch before
        std::size_t known_from = 0;  // the same, of the last stretch whose height is not known
    };

    bool isClipped(std::size_t axis, double value);
    void follow(std::size_t axis, bool clipped);
    void close(std::size_t axis);
    ImuSamples release();
    const ImuSample& sample(std::size_t number) const { return samples_[number - forgotten_]; }

    WarningSink warn_;
    std::array<Axis, kAxes> axes_;
    std::deque<ImuSample> samples_;  // those that tell how a stretch begins, then those held back
    std::size_t forgotten_ = 0;      // number of the first of samples_
    std::size_t next_ = 0;           // number of the first that is held back
    std::size_t clipped_ = 0;
};
}  // namespace taut
