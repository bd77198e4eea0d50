#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <thread>

#include "../Signals.h"
#include "../SlamRun.h"
#include "Options.h"
#include "taut/core/format.h"
#include "taut/inspection/Inspection.h"
#include "taut/rawlog/PrefetchedRawlog.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/session/registerSession.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace taut
{
namespace
{
const std::atomic<bool>& interrupted = interruption();

/** Waits for a log to grow that another program writes. */
class Following
{
 public:
    Following(std::string path, double patience) : path_(std::move(path)), patience_(patience) {}

    /** Called by the thread that reads, at the end of the log. */
    LogGrowth wait()
    {
        std::error_code error;
        const auto now = Clock::now();
        const auto size = std::filesystem::file_size(path_, error);
        if (!error && size != size_)
        {
            size_ = size;
            since_ = now;
        }
        if (interrupted) return LogGrowth::Left;
        if (std::chrono::duration<double>(now - since_).count() >= patience_)
        {
            gave_up_ = true;
            return LogGrowth::Complete;
        }
        std::this_thread::sleep_for(kLook);
        return LogGrowth::More;
    }

    /** How it ended. */
    std::string ending() const
    {
        return gave_up_ ? format(
                              "'%s' has not grown for %g s: it is taken as complete", path_.c_str(),
                              patience_)
                        : "'" + path_ + "' is not followed any longer";
    }

 private:
    using Clock = std::chrono::steady_clock;
    static constexpr auto kLook = std::chrono::milliseconds(5);

    std::string path_;
    double patience_;
    std::uintmax_t size_ = 0;
    Clock::time_point since_ = Clock::now();
    std::atomic<bool> gave_up_{false};
};

/** Nothing tells the pose of the LiDAR: whether the identity fits, by the begin of the
 * recording. */
void checkPose(const Options& options, SlamRun& run)
{
    constexpr double kLooked = 60;  // [s]
    run.tell("the recording does not tell the pose of its LiDAR: checking the identity");
    InspectionConfig config;
    config.log = options.log;
    config.log.only_first_n = 0;
    config.log.to_time = std::min(config.log.to_time, config.log.from_time + kLooked);
    Executor executor(options.threads);
    Findings findings;
    try
    {
        findings = inspectRecording(config, executor).findings;
    }
    catch (const std::exception&)
    {
        // Nothing can be read there: the run itself tells it.
    }
    for (const Finding& finding : findings)
        if (finding.kind == "extrinsic_rotation")
            run.warnings().add(
                {finding.t, finding.kind,
                 "nothing tells the pose of the LiDAR on the IMU, and it is not the "
                 "identity: " +
                     finding.text + "; " + finding.advice});
}

/** The exit code. */
int process(const Options& options, SlamRun& run)
{
    const bool follow = options.follow > 0;
    Following following(options.log.path, options.follow);
    RawlogConfig log_config = options.log, again = options.log;
    if (follow)
    {
        log_config.wait_for_growth = [&] { return following.wait(); };
        again.wait_for_growth = [] { return LogGrowth::Left; };
    }
    PrefetchedRawlog log(log_config, run.warnings().sink());
    run.makeFolder({options.log.path, options.config, options.rig, options.truth});
    if (!log.progress().pose_told && log.progress().has_imu) checkPose(options, run);
    Session session(run.session(), run.warnings(), [&run](const Event& e) { run.take(e); });
    const SessionOutcome outcome = session.run(
        log,
        [&](double share)
        {
            if (session.inSecondPass())
                run.showSecondPass(share);
            else
                run.progress().update(std::min(share, 1.0), session.scans(), session.duration());
            // The log that is followed is read to where it is when the signal comes.
            return !interrupted || follow;
        },
        [again] { return std::make_unique<PrefetchedRawlog>(again); });
    if (follow) run.tell(following.ending());
    return run.end(outcome, log.progress().findings);
}

int run(int argc, char** argv)
{
    Options options;
    if (!parseOptions(argc, argv, options)) return 0;
    catchSignals();
    registerSession();
    registerRenderers();
    loadPlugins(options.plugins);
    SlamRun run(options, PoseStream::WhereNobodyReads::Wait);
    SessionConfig& config = run.session();
    config.input = options.log.path;
    if (!options.truth.empty()) config.truth = readTum(options.truth, run.warnings().sink());
    if (options.show_config)
    {
        std::cout << config.method.effective;
        return 0;
    }
    if (config.known_map && !config.method.slam.loops)
        throw UsageError("-m needs loops: slam.loops is false");
    return process(options, run);
}
}  // namespace
}  // namespace taut

int main(int argc, char** argv)
{
    return taut::runProgram(
        "taut-slam", [&] { return taut::run(argc, argv); }, {argv, argv + argc});
}
