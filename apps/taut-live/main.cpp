#include <cstdio>
#include <filesystem>
#include <iostream>

#include "../Signals.h"
#include "../SlamRun.h"
#include "Options.h"
#include "Recording.h"
#include "ReplaySource.h"
#include "taut/core/format.h"
#include "taut/rawlog/PrefetchedRawlog.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/session/registerSession.h"
#ifdef TAUT_WITH_SENSORS
#include "SensorSource.h"
#endif

namespace fs = std::filesystem;

namespace taut
{
namespace
{
using How = ObservationSource::Ending::How;

struct Sensors
{
    std::unique_ptr<ObservationSource> source;
    int gz_level = 1;
};

Sensors openSensors(const LiveOptions& options)
{
    if (!options.replay.empty())
        return {std::make_unique<ReplaySource>(options.replay, options.speed)};
#ifdef TAUT_WITH_SENSORS
    auto source = std::make_unique<SensorSource>(options.sensors);
    const int gz_level = source->gzLevel();
    return {std::move(source), gz_level};
#else
    throw UsageError(
        "this taut-live was built without MRPT's drivers (libmrpt-hwdrivers-dev): it can play "
        "recordings alone (--replay)");
#endif
}

/** One run of the program: from sensors to a recording and a folder of results. */
class LiveRun
{
 public:
    explicit LiveRun(const LiveOptions& options)
        : options_(options),
          run_(options, PoseStream::WhereNobodyReads::Drop),
          log_((fs::path(options.output) / "log.rawlog").string()),
          ages_(run_.rawlog(log_).rig.lidar.clock_offset)
    {
        SessionConfig& config = run_.session();
        if (config.known_map && !config.method.slam.loops)
            throw UsageError("-m needs loops: slam.loops is false");
        if (fs::exists(fs::symlink_status(log_)))
            throw UsageError("'" + log_ + "' is a recording, which is not written over");
        config.input = log_;
        config.live =
            LiveConfig{[this](const Scan& scan) { return ages_.of(scan); }, !options.never_less};
    }

    /** The exit code. */
    int execute()
    {
        const Sensors sensors = openSensors(options_);
        run_.makeFolder({options_.sensors, options_.replay, options_.config, options_.rig});
        RawlogRecorder recorder(log_, sensors.gz_level);
        Recording recording(
            *sensors.source, recorder, ages_, options_.duration,
            [] { return interruption().load(); });
        try
        {
            const SessionOutcome outcome = estimate(recorder, recording);
            recording.waitForEnd();
            tellEnd(recorder, recording);
            return exitCode(run_.end(outcome), recording);
        }
        catch (const std::exception& e)
        {
            recording.end();
            recording.waitForEnd();
            const auto& ending = recording.ending();
            if (ending && ending->how == How::Failed && ending->text != e.what())
                std::cerr << ending->text << '\n';
            if (recorder.observations() > 0) throw;
            fs::remove(log_);
            throw std::runtime_error("no observation came: nothing is recorded");
        }
    }

 private:
    SessionOutcome estimate(RawlogRecorder& recorder, const Recording& recording)
    {
        RawlogConfig config = run_.rawlog(log_), again = config;
        config.wait_for_growth = [&] { return recorder.waitForGrowth(); };
        again.wait_for_growth = [] { return LogGrowth::Complete; };
        PrefetchedRawlog log(config, run_.warnings().sink());
        Session session(run_.session(), run_.warnings(), [this](const Event& e) { run_.take(e); });
        const SessionOutcome outcome = session.run(
            log,
            [&](double share)
            {
                if (session.inSecondPass())
                    run_.showSecondPass(share);
                else
                    show(session);
                return true;  // what was recorded is used; a second signal ends it at once
            },
            [again] { return std::make_unique<PrefetchedRawlog>(again); });
        if (!recording.ended() && !outcome.failure.empty())
            std::cerr << "the estimation has failed, the recording goes on: " << outcome.failure
                      << '\n';
        return outcome;
    }

    void show(const Session& session)
    {
        const auto age = session.age();
        run_.progress().update(
            format("%.1f s  %d scans", session.duration(), session.scans()) +
            (age ? format("  pose after %.0f ms", 1e3 * *age) : ""));
    }

    void tellEnd(const RawlogRecorder& recorder, const Recording& recording)
    {
        if (recording.ending()) run_.tell(recording.ending()->text);
        run_.tell(format("%zu observations recorded in ", recorder.observations()) + log_);
    }

    static int exitCode(int of_estimation, const Recording& recording)
    {
        const auto& ending = recording.ending();
        if (ending && ending->how == How::Failed) throw std::runtime_error(ending->text);
        return of_estimation == 0 && ending && ending->how == How::Partly ? 3 : of_estimation;
    }

    const LiveOptions& options_;
    SlamRun run_;
    std::string log_;
    ScanAges ages_;
};

int run(int argc, char** argv)
{
    LiveOptions options;
    if (!parseOptions(argc, argv, options)) return 0;
    catchSignals();
    registerSession();
    registerRenderers();
    loadPlugins(options.plugins);
    return LiveRun(options).execute();
}
}  // namespace
}  // namespace taut

int main(int argc, char** argv)
{
    return taut::runProgram("taut-live", [&] { return taut::run(argc, argv); });
}
