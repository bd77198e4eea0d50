#include "taut/session/Session.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "taut/core/format.h"

namespace fs = std::filesystem;

namespace taut
{
namespace
{
void writeText(const fs::path& path, const std::string& text)
{
    std::ofstream file(path);
    file << text;
    file.close();
    if (!file) throw std::runtime_error("cannot write '" + path.string() + "'");
}

/** Warnings which say that a part of the input was not used. */
constexpr const char* kUnused[] = {"late_imu", "imu_late", "imu_silent", "lidar_ended"};
}  // namespace

Session::Session(const SessionConfig& config, WarningLog& warnings, EventSink events)
    : config_(config),
      warnings_(warnings),
      events_(std::move(events)),
      executor_(config.threads),
      map_(config.method.map_export, config.folder),
      files_(config.folder, config.method.odometry.keep_undistorted),
      metrics_(config.input),
      pipeline_(
          config.method.odometry, executor_, warnings.sink(), [this](const Event& e) { take(e); })
{
    writeText(fs::path(config_.folder) / "config.yaml", config_.method.effective);
    const fs::path rig = fs::path(config_.folder) / "rig.yaml";
    if (config_.rig.empty())
        fs::remove(rig);  // of the run before
    else
        writeText(rig, config_.rig);
}

Session::~Session() = default;

void Session::add(Measurement measurement)
{
    if (auto* sample = std::get_if<ImuSample>(&measurement))
        pipeline_.add(*sample);
    else
        pipeline_.add(std::move(std::get<Scan>(measurement)));
}

void Session::take(const Event& event)
{
    doubts_.add(event);
    if (const auto* estimated = std::get_if<Estimated>(&event))
    {
        const ScanResult& result = estimated->result;
        const NavState& x = result.estimate.state;
        metrics_.add(result);
        files_.add(result);
        if (!config_.method.refined)
        {
            files_.addPose({x.t, x.T_world_imu});
            map_.add(x, result.points);
        }
    }
    else if (const auto* refined = std::get_if<Refined>(&event);
             refined != nullptr && config_.method.refined)
    {
        files_.addPose({refined->state.t, refined->state.T_world_imu});
        map_.add(refined->state, refined->points());
    }
    if (events_) events_(event);
}

SessionOutcome Session::run(MeasurementStream& log, const std::function<bool(double)>& go_on)
{
    bool interrupted = false;
    const auto begin = std::chrono::steady_clock::now();
    const std::string failure = processAll(log, go_on, interrupted);
    wall_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    SessionOutcome outcome = finish(log.progress(), log.incomplete(), interrupted);
    if (!failure.empty()) outcome.failure = failure;
    return outcome;
}

std::string Session::processAll(
    MeasurementStream& log, const std::function<bool(double)>& go_on, bool& interrupted)
{
    try
    {
        while (std::optional<Measurement> m = log.next())
        {
            add(std::move(*m));
            interrupted = !go_on(log.progress().fraction());
            if (interrupted) return {};
        }
        pipeline_.finish();
    }
    catch (const std::exception& e)
    {
        return e.what();
    }
    return {};
}

SessionOutcome Session::finish(const StreamProgress& log, bool incomplete, bool interrupted)
{
    SessionOutcome outcome;
    outcome.interrupted = interrupted;
    try
    {
        pipeline_.finish();
    }
    catch (const std::exception& e)
    {
        outcome.failure = e.what();
    }
    files_.close();
    map_.finish(warnings_.sink());
    outcome.poses = files_.poses();
    outcome.pictures_failed = config_.pictures && outcome.poses > 0 && !drawPictures();
    writeMetrics(log, incomplete, interrupted);
    outcome.length = files_.length();
    outcome.duration = metrics_.duration();
    outcome.wall_seconds = wall_seconds_;
    outcome.milliseconds_a_scan = metrics_.meanMilliseconds();
    outcome.map_points = map_.points();
    outcome.partly = interrupted || usedPartly(log, incomplete);
    return outcome;
}

bool Session::usedPartly(const StreamProgress& log, bool incomplete) const
{
    if (incomplete || log.skipped > 0 || doubts_.serious()) return true;
    for (const char* kind : kUnused)
        if (warnings_.count(kind) > 0) return true;
    return false;
}

std::vector<std::string> Session::caption() const
{
    return {
        fs::path(config_.input).filename().string(),
        format(
            "%.1f m, %.1f s, %d scans, undistortion: %s", files_.length(), metrics_.duration(),
            files_.poses(), nameOf(config_.method.odometry.estimation.undistortion))};
}

bool Session::drawPictures() const
{
    try
    {
        const std::unique_ptr<Renderer> renderer = config_.method.renderer.create();
        const RenderScene scene{map_.sample(), files_.sample(), caption()};
        for (const View view : kAllViews)
            renderer->render(
                scene, view,
                (fs::path(config_.folder) / ("snapshot_" + std::string(nameOf(view)) + ".png"))
                    .string());
        return true;
    }
    catch (const std::exception& e)
    {
        warnings_.add({0, "no_pictures", e.what()});
        return false;
    }
}

void Session::writeMetrics(const StreamProgress& log, bool incomplete, bool interrupted)
{
    Metrics::Summary s;
    s.log = log;
    s.incomplete = incomplete;
    s.interrupted = interrupted;
    s.with_imu = pipeline_.withImu();
    if (pipeline_.initialization()) s.rest_seconds = pipeline_.initialization()->rest_duration;
    s.length = files_.length();
    s.map_points = map_.points();
    s.map_cells = pipeline_.mapSize();
    s.key_scans = map_.keyScans();
    s.occupancy_resolution = map_.occupancyResolution();
    s.mode = nameOf(config_.method.odometry.estimation.undistortion);
    s.method_file = config_.method_file;
    s.threads = config_.threads;
    s.wall_seconds = wall_seconds_;
    s.doubts = doubts_.all();
    writeText(fs::path(config_.folder) / "metrics.json", metrics_.json(s, warnings_));
}
}  // namespace taut
