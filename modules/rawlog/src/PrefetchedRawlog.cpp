#include "taut/rawlog/PrefetchedRawlog.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace taut
{
namespace
{
constexpr std::size_t kMaxSteps = 10'000;  // IMU samples weigh little

/** What one call of the source's next() brought. */
struct Step
{
    std::vector<Warning> warnings;
    std::optional<Measurement> measurement;
    std::exception_ptr error;
    StreamProgress progress;
    bool incomplete = false;

    bool last() const { return !measurement; }
    bool isScan() const { return measurement && std::holds_alternative<Scan>(*measurement); }
};
}  // namespace

struct PrefetchedRawlog::Impl
{
    Impl(const RawlogConfig& config, WarningSink w, std::size_t c)
        : warn(std::move(w)),
          max_scans(c > 0 ? c : 1),
          source(
              stoppable(config), [this](const Warning& warning) { warnings.push_back(warning); }),
          progress(source.progress()),
          reader([this] { read(); })
    {
    }

    ~Impl()
    {
        {
            const std::lock_guard lock(mutex);
            stop = true;
        }
        changed.notify_all();
        reader.join();
    }

    RawlogConfig stoppable(RawlogConfig config);
    void read();
    std::optional<Measurement> next();

    WarningSink warn;
    std::size_t max_scans;
    std::atomic<bool> stop{false};  // before the source, which asks it
    std::vector<Warning> warnings;  // of the step being read; the reader's own once it runs
    RawlogSource source;

    std::mutex mutex;
    std::condition_variable changed;
    std::deque<Step> steps;
    std::size_t scans = 0;  // in steps

    StreamProgress progress;  // the consumer's own from here
    bool incomplete = false, finished = false;

    std::thread reader;  // last: the thread uses all of the above
};

/** It need not wait for a log to grow when nobody reads on. */
RawlogConfig PrefetchedRawlog::Impl::stoppable(RawlogConfig config)
{
    if (!config.wait_for_growth) return config;
    config.wait_for_growth = [this, wait = std::move(config.wait_for_growth)]
    { return stop ? LogGrowth::Left : wait(); };
    return config;
}

void PrefetchedRawlog::Impl::read()
{
    for (bool more = true; more;)
    {
        Step step;
        try
        {
            step.measurement = source.next();
        }
        catch (...)
        {
            step.error = std::current_exception();
        }
        step.warnings = std::exchange(warnings, {});
        step.progress = source.progress();
        step.incomplete = source.incomplete();
        more = !step.last();

        std::unique_lock lock(mutex);
        changed.wait(
            lock,
            [this] { return stop.load() || (scans < max_scans && steps.size() < kMaxSteps); });
        if (stop) return;
        scans += step.isScan();
        steps.push_back(std::move(step));
        lock.unlock();
        changed.notify_all();
    }
}

std::optional<Measurement> PrefetchedRawlog::Impl::next()
{
    if (finished) return {};
    std::unique_lock lock(mutex);
    changed.wait(lock, [this] { return !steps.empty(); });
    Step step = std::move(steps.front());
    steps.pop_front();
    scans -= step.isScan();
    lock.unlock();
    changed.notify_all();

    progress = std::move(step.progress);
    finished = step.last();
    incomplete = finished && step.incomplete;
    if (warn)
        for (const auto& warning : step.warnings) warn(warning);
    if (step.error) std::rethrow_exception(step.error);
    return std::move(step.measurement);
}

PrefetchedRawlog::PrefetchedRawlog(
    const RawlogConfig& config, WarningSink warn, std::size_t max_scans)
    : impl_(std::make_unique<Impl>(config, std::move(warn), max_scans))
{
}
PrefetchedRawlog::~PrefetchedRawlog() = default;

std::optional<Measurement> PrefetchedRawlog::next()
{
    return impl_->next();
}

StreamProgress PrefetchedRawlog::progress() const
{
    return impl_->progress;
}

bool PrefetchedRawlog::incomplete() const
{
    return impl_->incomplete;
}
}  // namespace taut
