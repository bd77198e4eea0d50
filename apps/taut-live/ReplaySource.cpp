#include "ReplaySource.h"

#include <utility>

namespace taut
{
ReplaySource::ReplaySource(const std::string& path, double speed)
    : path_(path), speed_(speed), replay_(path)
{
}

ReplaySource::~ReplaySource()
{
    stop();
}

void ReplaySource::start(Sink sink)
{
    thread_ = std::thread(
        [this, sink = std::move(sink)]
        {
            try
            {
                play(sink);
            }
            catch (const std::exception& e)
            {
                end({Ending::How::Failed, e.what()});
            }
        });
}

void ReplaySource::play(const Sink& sink)
{
    const auto begin = Clock::now();
    std::optional<Time> first;
    std::size_t given = 0;
    while (const auto item = replay_.next())
    {
        if (!first) first = item->due;
        Clock::time_point whole = Clock::now();
        if (speed_ > 0)
            whole = begin + std::chrono::nanoseconds(static_cast<std::int64_t>(
                                static_cast<double>(item->due - *first) / speed_));
        if (!waitUntil(whole)) return;
        sink(*item->observation, whole);
        given++;
    }
    std::string text = "end of '" + path_ + "': " + std::to_string(given) + " observations";
    if (replay_.leftOut() > 0)
        text += ", without " + std::to_string(replay_.leftOut()) + " of other sensors";
    const bool damaged = !replay_.damage().empty();
    if (damaged) text += "; it cannot be read on: " + replay_.damage();
    end({damaged ? Ending::How::Partly : Ending::How::Whole, text});
}

/* False if it is to stop. */
bool ReplaySource::waitUntil(Clock::time_point t)
{
    std::unique_lock lock(mutex_);
    return !changed_.wait_until(lock, t, [this] { return stop_; });
}

void ReplaySource::end(Ending ending)
{
    const std::lock_guard lock(mutex_);
    ending_ = std::move(ending);
}

void ReplaySource::stop()
{
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

std::optional<ObservationSource::Ending> ReplaySource::ending() const
{
    const std::lock_guard lock(mutex_);
    return ending_;
}
}  // namespace taut
