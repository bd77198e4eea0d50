#include "taut/completion/SweepCompleter.h"

#include <utility>

namespace taut
{
namespace
{
constexpr std::size_t kSweepsForRings = 10;

bool hasNoTimes(const Scan& scan)
{
    return scan.already_undistorted && scan.points.size() > 1;
}
}  // namespace

bool SweepCompleter::learn(Scan scan)
{
    if (!rings_judged_)
    {
        if (first_.empty() && scan.rings > 0 && !hasNoTimes(scan)) return false;
        first_.push_back(std::move(scan));
        if (first_.size() == kSweepsForRings) learnRings();
        return !turn_is_learnt_;
    }
    if (scan.rings == 0) rings_.apply(scan);
    if (hasNoTimes(scan)) turn_is_learnt_ = !turn_.learn(scan);
    return !turn_is_learnt_;
}

/** Rings first: by them the lasers are told apart whose points come one after the other. */
void SweepCompleter::learnRings()
{
    rings_judged_ = true;
    std::vector<const Scan*> without_rings;
    for (const Scan& scan : first_)
        if (scan.rings == 0) without_rings.push_back(&scan);
    if (!without_rings.empty())
    {
        rings_.learn(without_rings);
        findings_.push_back(rings_.finding());
    }
    for (Scan& scan : first_)
    {
        if (!hasNoTimes(scan)) continue;
        no_times_ = true;
        if (scan.rings == 0) rings_.apply(scan);
        turn_is_learnt_ = !turn_.learn(scan);
    }
    if (!no_times_) turn_is_learnt_ = true;
    first_.clear();
}

void SweepCompleter::finishLearning()
{
    if (!rings_judged_ && !first_.empty()) learnRings();
    if (!no_times_ || undistorted_) return;
    turn_.finishLearning();
    findings_.push_back(turn_.finding());
}

void SweepCompleter::complete(Scan& scan) const
{
    if (scan.rings == 0) rings_.apply(scan);
    if (hasNoTimes(scan)) turn_.apply(scan, stamp_is_end_);
}
}  // namespace taut
