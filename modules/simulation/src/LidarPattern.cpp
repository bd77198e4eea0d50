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
    SpinningPattern(
        std::vector<Laser> lasers, double firing_period, double rotation_rate, double beam_origin,
        int packet_firings)
        : lasers_(std::move(lasers)),
          firing_period_(firing_period),
          rate_(rotation_rate),
          beam_origin_(beam_origin),
          packet_firings_(packet_firings)
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
                const double head = 2 * M_PI * rate_ * toSeconds(shot.t);
                shot.origin = beam_origin_ * Vector3d(std::cos(head), -std::sin(head), 0);
                const double azimuth = head + l.azimuth;
                shot.direction = {
                    std::cos(l.elevation) * std::cos(azimuth),
                    -std::cos(l.elevation) * std::sin(azimuth), std::sin(l.elevation)};
                shot.ring = static_cast<std::uint16_t>(laser);
                shots.push_back(shot);
            }
        return shots;
    }
    Duration period() const override { return fromSeconds(1 / rate_); }
    Duration packet() const override { return fromSeconds(packet_firings_ * firing_period_); }
    int rings() const override { return static_cast<int>(lasers_.size()); }

 private:
    std::vector<Laser> lasers_;
    double firing_period_, rate_, beam_origin_;
    int packet_firings_;
};

class RosettePattern : public LidarPattern
{
 public:
    explicit RosettePattern(double sweep_rate)
        : shots_(static_cast<std::int64_t>(std::llround(kPointRate / sweep_rate)))
    {
    }

    std::vector<Shot> sweep(int k) const override
    {
        std::vector<Shot> shots;
        for (std::int64_t i = k * shots_; i < (k + 1) * shots_; i++)
        {
            Shot shot;
            shot.t = ticked(static_cast<double>(i) / kPointRate);
            const double t = toSeconds(shot.t);
            const double first = 2 * M_PI * kFirstPrism * t, second = 2 * M_PI * kSecondPrism * t;
            // Each prism bends the beam by the same small angle, in the direction it is turned to.
            const double y = kBend * (std::cos(first) + std::cos(second));
            const double z = kBend * (std::sin(first) + std::sin(second));
            const double angle = std::hypot(y, z);
            const double sine_over = angle > 1e-9 ? std::sin(angle) / angle : 1;
            shot.direction = {std::cos(angle), sine_over * y, sine_over * z};
            shots.push_back(shot);
        }
        return shots;
    }
    Duration period() const override
    {
        return fromSeconds(static_cast<double>(shots_) / kPointRate);
    }
    Duration packet() const override { return fromSeconds(kPacket / kPointRate); }
    int rings() const override { return 0; }

 private:
    static constexpr double kPacket = 96;                                            // points
    static constexpr double kPointRate = 100000;                                     // [1/s]
    static constexpr double kFirstPrism = 7294.0 / 60, kSecondPrism = -4664.0 / 60;  // [Hz]
    static constexpr double kBend = 70.4 / 4 * kDegree;  // of each prism
    std::int64_t shots_;
};
}  // namespace

std::unique_ptr<LidarPattern> makeSpinningPattern(
    std::vector<Laser> lasers, double firing_period, double rotation_rate, double beam_origin,
    int packet_firings)
{
    if (lasers.empty() || !(firing_period > 0) || !(rotation_rate > 0) ||
        rotation_rate * firing_period > 0.5)
        throw std::invalid_argument("a spinning LiDAR needs lasers, and several firings a turn");
    return std::make_unique<SpinningPattern>(
        std::move(lasers), firing_period, rotation_rate, beam_origin, packet_firings);
}

std::unique_ptr<LidarPattern> makeVlp16Pattern(double rotation_rate)
{
    std::vector<Laser> lasers;
    for (int i = 0; i < 16; i++)
    {
        const double elevation = i % 2 == 0 ? -15 + i : i;
        lasers.push_back({elevation * kDegree, 0, 2.304e-6 * i});
    }
    return makeSpinningPattern(std::move(lasers), 55.296e-6, rotation_rate, 0, 24);
}

std::unique_ptr<LidarPattern> makeHdl32Pattern(double rotation_rate)
{
    std::vector<Laser> lasers;
    for (int i = 0; i < 32; i++)
    {
        const int row = i % 2 == 0 ? i / 2 : 16 + i / 2;  // from below
        lasers.push_back({(-92.0 + 4 * row) / 3 * kDegree, 0, 1.152e-6 * i});
    }
    return makeSpinningPattern(std::move(lasers), 46.08e-6, rotation_rate, 0, 12);
}

std::unique_ptr<LidarPattern> makeHdl64Pattern(double rotation_rate)
{
    constexpr double sequence = 48e-6;
    std::vector<Laser> lasers;
    for (int i = 0; i < 32; i++)
    {
        const double delay = sequence / 32 * i;
        lasers.push_back({(2 - i / 3.0) * kDegree, 0, delay});
        lasers.push_back({(-8.83 - i / 2.0) * kDegree, 0, delay});
    }
    return makeSpinningPattern(std::move(lasers), sequence, rotation_rate, 0, 6);
}

std::unique_ptr<LidarPattern> makeOs1Pattern(int rows, double rotation_rate)
{
    const double half_view = rows == 64 ? 16.6 : 21.4, stagger = rows == 64 ? 2.11 : 2.81;
    std::vector<Laser> lasers;
    for (int i = 0; i < rows; i++)
    {
        const double elevation = half_view * (1 - 2.0 * i / (rows - 1));
        lasers.push_back({elevation * kDegree, (1.5 - i % 4) * stagger * kDegree, 0});
    }
    return makeSpinningPattern(
        std::move(lasers), 1 / (1024 * rotation_rate), rotation_rate,
        rows == 64 ? 12.163e-3 : 15.806e-3, 16);
}

std::unique_ptr<LidarPattern> makeRosettePattern(double sweep_rate)
{
    return std::make_unique<RosettePattern>(sweep_rate);
}
}  // namespace taut::simulation
