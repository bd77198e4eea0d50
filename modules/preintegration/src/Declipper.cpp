#include "taut/preintegration/Declipper.h"

#include <algorithm>
#include <cmath>

#include "taut/core/format.h"

namespace taut
{
namespace
{
// No gyro ends below 125 deg/s, no accelerometer below 2 g.
constexpr double kSmallestGyroRange = 2.0;    // [rad/s]
constexpr double kSmallestAccelRange = 19.0;  // [m/s^2]
constexpr int kRepeated = 4;                  // equal extremes in a row show a limit
constexpr double kSame = 1e-4;                // share of a limit: its two ends differ by one bit

// Samples beside a stretch that tell its slope.
constexpr double kBeside = 0.025;        // [s], and
constexpr std::size_t kFewBeside = 3;    // samples at least
constexpr double kTogether = 0.01;       // [s] between clipped samples of one stretch
constexpr std::size_t kMostBeside = 64;  // samples

// Standard deviation of what the cubic misses, as shares of its height and of the limit.
constexpr double kHeightMissed = 0.3, kLimitMissed = 0.02;
/** The same, as a share of the limit, where a stretch has no end that would tell its height. */
constexpr double kUnknownHeight = 0.3;

bool isGyro(std::size_t axis)
{
    return axis < 3;
}

double& valueOf(ImuSample& s, std::size_t axis)
{
    const auto i = static_cast<Eigen::Index>(axis);
    return isGyro(axis) ? s.gyro[i] : s.accel[i - 3];
}

double valueOf(const ImuSample& s, std::size_t axis)
{
    const auto i = static_cast<Eigen::Index>(axis);
    return isGyro(axis) ? s.gyro[i] : s.accel[i - 3];
}

/** A straight line v + slope (t - t_0), fitted by least squares. */
class LineFit
{
 public:
    void add(double t, double v)
    {
        n_++;
        t_ += t;
        v_ += v;
        tt_ += t * t;
        tv_ += t * v;
    }
    bool isGiven() const { return n_ >= 2; }
    double slope() const
    {
        const double spread = tt_ - t_ * t_ / n_;
        return spread > 0 ? (tv_ - t_ * v_ / n_) / spread : 0;
    }
    double at(double t) const { return v_ / n_ + slope() * (t - t_ / n_); }

 private:
    double n_ = 0, t_ = 0, v_ = 0, tt_ = 0, tv_ = 0;
};
}  // namespace

void ImuRange::declare(ConfigSection& section)
{
    section.key(
        "gyro_range", gyro, kNotNegative,
        "rad/s, largest rate that the gyro measures; 0: told from repeated extremes");
    section.key("accel_range", accel, kNotNegative, "m/s^2, the same of the accelerometer");
}

Declipper::Declipper(const ImuRange& range, WarningSink warn) : warn_(std::move(warn))
{
    for (std::size_t i = 0; i < kAxes; i++)
    {
        const double limit = isGyro(i) ? range.gyro : range.accel;
        axes_[i].configured = limit > 0;
        if (limit > 0) axes_[i].limit = limit;
    }
}

bool Declipper::isClipped(std::size_t i, double value)
{
    Axis& axis = axes_[i];
    const double size = std::abs(value);
    axis.run = value == axis.previous ? axis.run + 1 : 1;
    axis.previous = value;
    if (axis.limit && !axis.configured && size > *axis.limit * (1 + kSame))
        axis.limit.reset();  // it was none
    const bool extreme =
        size >= axis.largest && size >= (isGyro(i) ? kSmallestGyroRange : kSmallestAccelRange);
    axis.largest = std::max(axis.largest, size);
    if (!axis.limit && extreme && axis.run >= kRepeated) axis.limit = size;
    if (axis.limit) return size >= *axis.limit * (1 - kSame);
    return extreme && axis.run >= 2;  // it may prove to be one
}

ImuSamples Declipper::add(const ImuSample& sample)
{
    samples_.push_back(sample);
    for (std::size_t i = 0; i < kAxes; i++) follow(i, isClipped(i, valueOf(sample, i)));
    return release();
}

void Declipper::follow(std::size_t i, bool clipped)
{
    Axis& axis = axes_[i];
    const std::size_t now = forgotten_ + samples_.size() - 1;
    const Time t = sample(now).t;
    if (axis.open)
    {
        const std::size_t after = now - axis.open->last;
        const double seconds_after = toSeconds(t - sample(axis.open->last).t);
        const bool same_end = valueOf(sample(now), i) * valueOf(sample(axis.open->last), i) > 0;
        const bool goes_on = clipped && same_end && (after == 1 || seconds_after <= kTogether);
        const bool over =
            (clipped && !goes_on) || (after >= kFewBeside && seconds_after >= kBeside);
        if (goes_on) axis.open->last = now;
        if (over || toSeconds(t - sample(axis.open->first).t) >= kLongest) close(i);
    }
    if (clipped && !axis.open && now >= axis.free_from) axis.open = Stretch{now, now};
}

ImuSamples Declipper::finish()
{
    for (std::size_t i = 0; i < kAxes; i++)
        if (axes_[i].open) close(i);
    return release();
}

ImuSamples Declipper::release()
{
    std::size_t end = forgotten_ + samples_.size();
    for (const Axis& axis : axes_)
        if (axis.open) end = std::min(end, axis.open->first);
    ImuSamples complete;
    for (; next_ < end; next_++) complete.push_back(sample(next_));
    for (; next_ - forgotten_ > kMostBeside; forgotten_++) samples_.pop_front();
    return complete;
}

void Declipper::close(std::size_t i)
{
    Axis& axis = axes_[i];
    const auto [first, last] = *axis.open;
    axis.open.reset();
    axis.free_from = last + 1;
    if (!axis.limit) return;  // equal readings, and then a higher one
    const double limit = *axis.limit;
    const double sign = valueOf(sample(first), i) > 0 ? 1 : -1;
    const auto timeOf = [&](std::size_t n) { return toSeconds(sample(n).t - sample(first).t); };
    const auto sizeOf = [&](std::size_t n) { return sign * valueOf(sample(n), i); };

    LineFit before, after;
    for (std::size_t n = first; n > std::max(forgotten_, axis.known_from); n--)
    {
        if (first - n >= kFewBeside && -timeOf(n - 1) > kBeside) break;
        before.add(timeOf(n - 1), sizeOf(n - 1));
    }
    for (std::size_t n = last + 1; n < forgotten_ + samples_.size(); n++)
        if (sizeOf(n) < limit * (1 - kSame)) after.add(timeOf(n), sizeOf(n));
    const bool both = before.isGiven() && after.isGiven();
    if (!both) axis.known_from = last + 1;
    const double begin = both ? timeOf(first - 1) : 0;
    const double duration = both ? timeOf(last + 1) - begin : 0;
    const auto cubic = [&](double t)
    {
        const double u = (t - begin) / duration, u2 = u * u, u3 = u2 * u;
        return (2 * u3 - 3 * u2 + 1) * before.at(begin) +
               (u3 - 2 * u2 + u) * duration * std::max(0.0, before.slope()) +
               (3 * u2 - 2 * u3) * after.at(begin + duration) +
               (u3 - u2) * duration * std::min(0.0, after.slope());
    };
    for (std::size_t n = first; n <= last; n++)
    {
        ImuSample& s = samples_[n - forgotten_];
        const bool is_clipped = sizeOf(n) >= limit * (1 - kSame);
        const double height = both ? std::max(0.0, cubic(timeOf(n)) - limit) : 0;
        double& hidden = isGyro(i) ? s.gyro_hidden : s.accel_hidden;
        hidden = std::hypot(
            hidden, both ? kHeightMissed * height + kLimitMissed * limit : kUnknownHeight * limit);
        if (!is_clipped) continue;
        valueOf(s, i) = sign * (limit + height);
        clipped_++;
    }
    if (!warn_) return;
    warn_(
        {sample(first).t, isGyro(i) ? "gyro_clipped" : "accel_clipped",
         format(
             "the %s along %c is at its limit of %.4g %s for %.3f s: what it hides is told from "
             "how the signal comes there and leaves, and from the LiDAR",
             isGyro(i) ? "gyro" : "accelerometer", "xyz"[i % 3], limit,
             isGyro(i) ? "rad/s" : "m/s^2", timeOf(last) - timeOf(first))});
}
}  // namespace taut
