#include "taut/simulation/LidarPattern.h"

#include <cmath>
#include <stdexcept>

namespace taut::simulation
{
namespace
{
constexpr double kDegree = M_PI / 180;
constexpr Duration kTick = 100;

Duration ticked(double seconds)
{
    return kTick * static_cast<Duration>(std::llround(seconds * 1e7));
}

class SpinningPattern : public LidarPattern
{
 public:
    SpinningPattern(std::vector<Laser> lasers, double firing_period, double rotation_rate)
        : lasers_(std::move(lasers)), firing_period_(firing_period), rate_(rotation_rate)
    {
    }

    std::vector<Shot> sweep(int k) const override
    {
        // A sequence belongs to the sweep in which it starts.
        const auto first = [this](int sweep)
        { return static_cast<std::int64_t>(std::ceil(sweep / rate_ / firing_period_ - 1e-9)); };
        std::vector<Shot> shots;
        for (std::int64_t i = first(k); i < first(k + 1); i++)
            for (std::size_t laser = 0; laser < lasers_.size(); laser++)
            {
                const Laser& l = lasers_[laser];
                Shot shot;
                shot.t = ticked(firing_period_ * static_cast<double>(i) + l.delay);
                const double azimuth = 2 * M_PI * rate_ * toSeconds(shot.t) + l.azimuth;
                shot.direction = {
                    std::cos(l.elevation) * std::sin(azimuth),
                    std::cos(l.elevation) * std::cos(azimuth), std::sin(l.elevation)};
                shot.ring = static_cast<std::uint16_t>(laser);
                shots.push_back(shot);
            }
        return shots;
    }
    Duration period() const override { return fromSeconds(1 / rate_); }
    int rings() const override { return static_cast<int>(lasers_.size()); }

 private:
    std::vector<Laser> lasers_;
    double firing_period_, rate_;
};
}  // namespace

std::unique_ptr<LidarPattern> makeSpinningPattern(
    std::vector<Laser> lasers, double firing_period, double rotation_rate)
{
    if (lasers.empty() || !(firing_period > 0) || !(rotation_rate > 0) ||
        rotation_rate * firing_period > 0.5)
        throw std::invalid_argument("a spinning LiDAR needs lasers, and several firings a turn");
    return std::make_unique<SpinningPattern>(std::move(lasers), firing_period, rotation_rate);
}

std::unique_ptr<LidarPattern> makeVlp16Pattern(double rotation_rate)
{
    std::vector<Laser> lasers;
    for (int i = 0; i < 16; i++)
    {
        const double elevation = i % 2 == 0 ? -15 + i : i;  // -15 1 -13 3 ... -1 15
        lasers.push_back({elevation * kDegree, 0, 2.304e-6 * i});
    }
    return makeSpinningPattern(std::move(lasers), 55.296e-6, rotation_rate);
}
}  // namespace taut::simulation
