#include "Recording.h"

#include <mrpt/obs/CObservation.h>

#include <utility>

#include "taut/rawlog/observationFacts.h"

namespace taut
{
namespace
{
constexpr auto kLook = std::chrono::milliseconds(20);
}  // namespace

Recording::Recording(
    ObservationSource& source, RawlogRecorder& recorder, ScanAges& ages, double duration,
    std::function<bool()> is_ended)
    : source_(source),
      recorder_(recorder),
      ages_(ages),
      thread_([this, duration, asked = std::move(is_ended)] { watch(duration, asked); })
{
}

Recording::~Recording()
{
    end();
    waitForEnd();
}

void Recording::watch(double duration, const std::function<bool()>& is_ended)
{
    using Clock = ObservationSource::Clock;
    const auto begin = Clock::now();
    source_.start(
        [this](const mrpt::obs::CObservation& observation, Clock::time_point whole)
        {
            // Before it is written: the estimation may be there at once.
            if (const auto stamp = stampOfScan(observation)) ages_.add(*stamp, whole);
            recorder_.write(observation);
        });
    const auto over = [&] {
        return duration > 0 &&
               std::chrono::duration<double>(Clock::now() - begin).count() >= duration;
    };
    while (!end_ && !is_ended() && !over() && !source_.ending()) std::this_thread::sleep_for(kLook);
    source_.stop();
    ending_ = source_.ending();
    try
    {
        recorder_.close();
    }
    catch (const std::exception& e)
    {
        ending_ = {ObservationSource::Ending::How::Failed, e.what()};
    }
    ended_ = true;
}

void Recording::waitForEnd()
{
    if (thread_.joinable()) thread_.join();
}
}  // namespace taut
