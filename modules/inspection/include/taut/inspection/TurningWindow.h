#pragma once

#include <deque>
#include <optional>

#include "taut/core/Imu.h"

namespace taut
{
/** Finds, while the samples pass by, the stretch of a recording in which the body turns most, and
 * about more than one axis: where a gyro says most about clocks and mounting. */
class TurningWindow
{
 public:
    /** `length` [s] of the window; shorter only where the samples hold no longer stretch. */
    explicit TurningWindow(double length) : length_(length) {}

    /** A gap of half a second, or time that goes backward, ends a stretch. */
    void add(const ImuSample& sample);

    struct Window
    {
        Time begin = 0, end = 0;
        double rate = 0;  //!< RMS of the angular rate about its mean, in the gyro's unit
    };
    /** The best window so far. */
    std::optional<Window> best() const;

 private:
    struct Bin  // about a second
    {
        Time begin = 0, end = 0;
        double count = 0;
        Vector3d sum = Vector3d::Zero();
        Matrix3d squares = Matrix3d::Zero();
    };
    void judge();

    double length_;
    std::deque<Bin> bins_;
    std::optional<Window> best_;
    double best_score_ = -1;
};
}  // namespace taut
