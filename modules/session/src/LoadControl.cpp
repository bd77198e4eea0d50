#include "taut/session/LoadControl.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace taut
{
namespace
{
constexpr std::array<double, 5> kShares{1, 0.7, 0.5, 0.35, 0.25};
constexpr double kMemory = 0.2;    // weight of a scan in the load
constexpr double kFull = 0.9;      // load that is too much
constexpr double kRoom = 0.7;      // load that there may be after a step up
constexpr double kLate = 2;        // intervals
constexpr int kSettle = 10;        // scans between two changes
constexpr double kShrinks = 0.9;   // of the lateness in so many scans: it is being caught up
constexpr double kTakenBack = 10;  // [s] after a step up: it was one too many
constexpr double kPatience = 5, kMostPatience = 80;  // [s]
}  // namespace

double LoadControl::share() const
{
    return kShares[static_cast<std::size_t>(step_)];
}

bool LoadControl::add(double interval, double work, std::optional<double> late)
{
    if (!(interval > 0) || !std::isfinite(interval) || !(work >= 0)) return false;
    const double load = work / interval;
    load_ = begun_ ? load_ + kMemory * (load - load_) : load;
    begun_ = true;
    since_change_++;
    if (since_more_) *since_more_ += interval;
    const bool less = mustDoLess(interval, late), more = mayDoMore(interval, late);
    if (since_change_ < kSettle) return false;
    if (less && step_ + 1 < static_cast<int>(kShares.size()))
    {
        step_++;
        if (since_more_ && *since_more_ < kTakenBack)
            patience_ = std::min(2 * patience_, kMostPatience);
        since_more_.reset();
    }
    else if (more && step_ > 0)
    {
        step_--;
        if (since_more_ && *since_more_ >= kTakenBack) patience_ = kPatience;
        since_more_ = 0;
    }
    else
    {
        return false;
    }
    since_change_ = 0;
    calm_ = 0;
    return true;
}

bool LoadControl::mustDoLess(double interval, std::optional<double> late)
{
    bool falls_behind = false;
    if (++since_look_ >= kSettle)
    {
        since_look_ = 0;
        falls_behind = late && late_before_ && std::min(*late, *late_before_) > kLate * interval &&
                       *late > kShrinks * *late_before_;
        late_before_ = late;
    }
    return load_ > kFull || falls_behind;
}

bool LoadControl::mayDoMore(double interval, std::optional<double> late)
{
    if (step_ == 0) return false;
    const double above = kShares[static_cast<std::size_t>(step_ - 1)];
    const bool calm = load_ * above / share() < kRoom && late.value_or(0) <= kLate * interval;
    calm_ = calm ? calm_ + interval : 0;
    return calm_ >= patience_;
}
}  // namespace taut
