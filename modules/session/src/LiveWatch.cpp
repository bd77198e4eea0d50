#include "taut/session/LiveWatch.h"

#include <algorithm>

namespace taut
{
std::optional<double> LiveWatch::add(const Scan& scan, double work)
{
    last_age_ = config_.age ? config_.age(scan) : std::nullopt;
    const double interval = last_ ? toSeconds(scan.end - *last_) : 0;
    last_ = scan.end;
    if (last_age_)
        poses_.push_back({scan.end, static_cast<float>(*last_age_), static_cast<float>(interval)});
    if (!reduced_.empty() && control_.share() < 1) reduced_.back().to = scan.end;
    if (interval <= 0) return {};  // before the first there was the start
    work_ += work;
    time_ += interval;
    if (!config_.may_do_less || !control_.add(interval, work, last_age_)) return {};
    if (control_.share() < 1) reduced_.push_back({scan.end, scan.end, control_.share()});
    return control_.share();
}

LiveSummary LiveWatch::summary() const
{
    LiveSummary summary;
    summary.load = time_ > 0 ? work_ / time_ : 0;
    summary.reduced = reduced_;
    const auto in_time = [](const Told& pose)
    { return pose.interval > 0 && pose.age <= pose.interval; };
    auto first = std::find_if(poses_.begin(), poses_.end(), in_time);
    if (first == poses_.end()) first = poses_.begin();  // it never was
    if (first == poses_.end()) return summary;
    summary.caught_up = toSeconds(first->t - poses_.front().t);
    std::vector<double> ages;
    for (auto pose = first; pose != poses_.end(); ++pose)
    {
        ages.push_back(pose->age);
        summary.late += in_time(*pose) ? 0 : 1;
    }
    std::sort(ages.begin(), ages.end());
    const auto at = [&](double share)
    { return ages[static_cast<std::size_t>(share * static_cast<double>(ages.size() - 1) + 0.5)]; };
    summary.scans = ages.size();
    summary.median = at(0.5);
    summary.percentile_99 = at(0.99);
    summary.worst = ages.back();
    return summary;
}
}  // namespace taut
