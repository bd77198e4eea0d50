#include "taut/inspection/GyroRotation.h"

#include <algorithm>

namespace taut
{
namespace
{
Eigen::Quaterniond turn(const Vector3d& rate, double seconds)
{
    return Eigen::Quaterniond(expSO3(rate * seconds));
}
}  // namespace

GyroRotation::GyroRotation(const ImuSamples& samples, double factor)
{
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    for (const ImuSample& s : samples)
    {
        const Vector3d rate = factor * s.gyro;
        if (!times_.empty())
            q = (q * turn((rates_.back() + rate) / 2, toSeconds(s.t - times_.back()))).normalized();
        times_.push_back(s.t);
        rates_.push_back(rate);
        rotations_.push_back(q);
    }
}

/* Index of the sample at the start of the interval that holds t. */
std::size_t GyroRotation::intervalOf(Time t) const
{
    const auto after = std::upper_bound(times_.begin(), times_.end() - 1, t);
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, after - times_.begin())) - 1;
}

Eigen::Quaterniond GyroRotation::at(Time t) const
{
    const std::size_t i = intervalOf(t);
    const double whole = toSeconds(times_[i + 1] - times_[i]), part = toSeconds(t - times_[i]);
    const Vector3d mean = rates_[i] + (rates_[i + 1] - rates_[i]) * (part / whole / 2);
    return rotations_[i] * turn(mean, part);
}

std::optional<Vector3d> GyroRotation::between(Time begin, Time end) const
{
    if (times_.size() < 2 || begin < times_.front() || end > times_.back()) return {};
    return logSO3((at(begin).conjugate() * at(end)).toRotationMatrix());
}

std::optional<Vector3d> GyroRotation::meanRate(Time begin, Time end) const
{
    auto turned = between(begin, end);
    if (turned && end > begin) *turned /= toSeconds(end - begin);
    return turned;
}

Duration GyroRotation::longestGap(Time begin, Time end) const
{
    if (times_.size() < 2 || begin < times_.front() || end > times_.back()) return end - begin;
    Duration longest = 0;
    for (std::size_t i = intervalOf(begin); i + 1 < times_.size() && times_[i] < end; i++)
        longest = std::max(longest, times_[i + 1] - times_[i]);
    return longest;
}
}  // namespace taut
