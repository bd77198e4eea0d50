#include "taut/rawlog/RawlogReplay.h"

#include <algorithm>

#include "MrptConversion.h"
#include "ObservationReader.h"
#include "ObservationToScan.h"

namespace taut
{
namespace
{
constexpr Duration kLongestPause = 1'000'000'000;

/** Of the last point where it is a scan that can be read; else of the stamp. */
Time wholeAt(const mrpt::obs::CObservation& observation)
{
    const Time stamp = toTime(observation.timestamp);
    if (!isLidar(observation)) return stamp;
    try
    {
        const Scan scan = observationToPoints(observation, {}).finish();
        return scan.points.empty() ? stamp : scan.end;
    }
    catch (const std::exception&)  // whoever uses the scan tells what is wrong with it
    {
        return stamp;
    }
}
}  // namespace

struct RawlogReplay::Impl
{
    explicit Impl(const std::string& path) : reader(path) {}

    ObservationReader reader;
    std::optional<Time> latest;  // stamp
    Time due = 0;
};

RawlogReplay::RawlogReplay(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}

RawlogReplay::~RawlogReplay() = default;

std::optional<RawlogReplay::Item> RawlogReplay::next()
{
    while (auto entry = impl_->reader.next())
    {
        if (!entry->observation)
        {
            left_out_++;
            continue;
        }
        const mrpt::obs::CObservation& observation = *entry->observation;
        if (isValidStamp(observation.timestamp))
        {
            const Time t = wholeAt(observation);
            if (!impl_->latest)
                impl_->due = t;
            else
                impl_->due += std::clamp<Duration>(t - *impl_->latest, 0, kLongestPause);
            // After a clock that was set back, time goes on from there.
            const bool set_back = impl_->latest && t < *impl_->latest - kLongestPause;
            impl_->latest = set_back ? t : std::max(t, impl_->latest.value_or(t));
        }
        return Item{std::move(entry->observation), impl_->due};
    }
    return {};
}

std::string RawlogReplay::damage() const
{
    return impl_->reader.damage();
}
}  // namespace taut
