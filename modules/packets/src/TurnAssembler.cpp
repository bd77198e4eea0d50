#include "taut/packets/TurnAssembler.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace taut
{
namespace
{
constexpr int kFullTurn = 36000;                // [0.01 deg]
constexpr int kGap = 3000;                      // [0.01 deg] more than between two blocks
constexpr Duration kLongestTurn = 250'000'000;  // 5 Hz is the slowest turn
constexpr Duration kJitter = 200'000;           // of the times of blocks in order
constexpr Duration kLatest = 50'000'000;        // a block that is no sign of another clock
constexpr std::size_t kMostPoints = 2'000'000;  // whatever the clock says

/** A difference of azimuths, -18000 to 17999. */
int wrapped(int difference)
{
    return (difference + 3 * kFullTurn / 2) % kFullTurn - kFullTurn / 2;
}
}  // namespace

void TurnAssembler::beginBlock(int azimuth, Time t, std::vector<Scan>& complete)
{
    // Packets may be captured in another order than they were sent.
    const bool late = last_azimuth_ >= 0 && last_ - t > kJitter && last_ - t < kLatest;
    if (!late)
    {
        if (last_azimuth_ >= 0) step(azimuth, complete);
        last_azimuth_ = azimuth;
        last_ = t;
    }
    if (std::abs(t - base_) > kLongestTurn || points_.size() >= kMostPoints) close(complete);
    if (points_.empty()) base_ = t;
}

void TurnAssembler::step(int azimuth, std::vector<Scan>& complete)
{
    const int plain = azimuth - last_azimuth_;
    int step = wrapped(plain);
    const bool gap = std::abs(step) > kGap;
    if (!gap && step != 0) forward_ = step > 0;
    if (gap)  // whichever way is shorter, the head went on
        step = forward_ ? (plain + kFullTurn) % kFullTurn : -((kFullTurn - plain) % kFullTurn);
    const bool passed_zero = plain != step;
    travelled_ += step;
    const bool whole_turn = std::abs(travelled_) >= kFullTurn;
    switch (cut_)
    {
        case Cut::Unknown:
            if (gap || whole_turn) cut_ = gap ? Cut::InGap : Cut::AtZero;
            if (cut_ == Cut::AtZero) closeAtZero(complete);
            if (gap || (whole_turn && passed_zero))
                close(complete);
            else if (passed_zero)
                zero_at_ = points_.size();
            break;
        case Cut::InGap:
            if (whole_turn && !gap) cut_ = Cut::AtZero;  // that gap was lost, not left out
            if (gap || whole_turn) close(complete);
            break;
        case Cut::AtZero:
            if (passed_zero) close(complete);
            break;
    }
    if (gap || whole_turn) travelled_ = 0;
}

void TurnAssembler::add(const Eigen::Vector3f& position, float intensity, int ring, Time t)
{
    LidarPoint point;
    point.position = position;
    point.intensity = intensity;
    point.offset = static_cast<std::int32_t>(t - base_);
    point.ring = static_cast<std::uint16_t>(ring);
    points_.push_back(point);
}

void TurnAssembler::finish(std::vector<Scan>& complete)
{
    closeAtZero(complete);
    close(complete);
}

/* What came before zero; the rest begins the next turn. */
void TurnAssembler::closeAtZero(std::vector<Scan>& complete)
{
    if (!zero_at_) return;
    std::vector<LidarPoint> rest(
        points_.begin() + static_cast<std::ptrdiff_t>(*zero_at_), points_.end());
    points_.resize(*zero_at_);
    close(complete);
    points_ = std::move(rest);
    if (points_.empty()) return;
    const std::int32_t begin = points_.front().offset;
    base_ += begin;
    for (LidarPoint& point : points_) point.offset -= begin;
}

void TurnAssembler::close(std::vector<Scan>& complete)
{
    zero_at_.reset();
    if (points_.empty()) return;
    const auto [first, last] = std::minmax_element(
        points_.begin(), points_.end(),
        [](const LidarPoint& a, const LidarPoint& b) { return a.offset < b.offset; });
    const std::int32_t begin = first->offset, end = last->offset;
    Scan scan;
    scan.stamp = base_ + begin;
    scan.end = base_ + end;
    scan.rings = rings_;
    scan.points = std::exchange(points_, {});
    for (LidarPoint& point : scan.points) point.offset -= begin;
    complete.push_back(std::move(scan));
}
}  // namespace taut
