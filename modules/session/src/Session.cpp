#include "taut/session/Session.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "DiskReserve.h"
#include "TaskQueue.h"
#include "drawViews.h"
#include "takeOutMovedThings.h"
#include "taut/core/format.h"
#include "taut/core/writeError.h"
#include "taut/graph/G2oFile.h"
#include "taut/report/writeReport.h"
#include "taut/session/ResultFolder.h"
#include "taut/session/RunReport.h"
#include "taut/slam/LoopsFile.h"
#include "taut/slam/SimpleMapFile.h"

namespace fs = std::filesystem;

namespace taut
{
namespace
{
void writeText(const fs::path& path, const std::string& text)
{
    errno = 0;
    std::ofstream file(path);
    file << text;
    if (!file) throw writeError(path.string());
    flushOrThrow(file, path.string());
}

double secondsSince(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/** Warnings which say that a part of the input was not used, or not as it is. */
constexpr const char* kUnused[] = {"late_imu",      "imu_late",           "imu_silent",
                                   "imu_not_found", "lidar_ended",        "place_unknown",
                                   "clock_back",    "extrinsic_rotation", "too_slow"};

/** Scans whose points wait for the mapper in memory, in a live run. */
constexpr std::size_t kMostBeside = 200;
}  // namespace

Session::Session(const SessionConfig& config, WarningLog& warnings, EventSink events)
    : config_(config),
      warnings_(warnings),
      events_(std::move(events)),
      executor_(config.threads),
      reserve_(std::make_unique<DiskReserve>(config.folder)),
      map_(std::make_unique<MapExport>(config.method.map_export, config.folder)),
      path_(std::make_unique<PathFiles>(config.folder)),
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
    if (config_.known_map && fs::equivalent(config_.known_map->folder, config_.folder))
        throw std::runtime_error("the results would overwrite the map that they are joined to");
    removeLoopResults(config_.folder);
    if (config_.method.slam.loops)
    {
        if (config_.live) mapper_executor_ = std::make_unique<Executor>(1);
        mapper_ = std::make_unique<Mapper>(
            config_.method.slam, config_.folder + "/submaps",
            config_.live ? *mapper_executor_ : executor_,
            config_.live ? [this](const Warning& w)
            {
                const std::lock_guard lock(mapper_warnings_mutex_);
                mapper_warnings_.push_back(w);
            } : warnings_.sink());
        if (config_.known_map) mapper_->use(*config_.known_map);
        if (config_.live) beside_ = std::make_unique<TaskQueue>(kMostBeside);
    }
    if (config_.live) watch_.emplace(*config_.live);
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
    const auto* estimated = std::get_if<Estimated>(&event);
    if (watch_ && estimated != nullptr) watchLoad(*estimated);
    // A pose that is waited for is told before it is written.
    if (config_.live && events_) events_(event);
    written_ = false;
    write(event);
    passWarningsOn();
    written_ = true;
    if (!config_.live && events_) events_(event);
}

void Session::watchLoad(const Estimated& estimated)
{
    const auto now = std::chrono::steady_clock::now();
    const double work =
        std::chrono::duration<double>(now - last_estimated_).count() - (idle_seconds_ - last_idle_);
    last_estimated_ = now;
    last_idle_ = idle_seconds_;
    const double before = watch_->control().share();
    const auto share = watch_->add(estimated.scan, work);
    if (!share) return;
    pipeline_.setShare(*share);
    const double load = watch_->control().load(), late = watch_->age().value_or(0);
    if (*share < before)
        warnings_.add(
            {estimated.scan.end, "too_slow",
             format(
                 "%.0f %% of each scan is used from here on: the work takes %.0f %% of the time, "
                 "poses are %.2f s late",
                 100 * *share, 100 * load, late)});
    else if (*share == 1)
        warnings_.add(
            {estimated.scan.end, "fast_enough",
             format(
                 "all of each scan is used again: the work takes %.0f %% of the time",
                 100 * load)});
}

/** A step of the mapper: now, or in the thread beside. */
void Session::tellMapper(std::function<void()> step)
{
    if (beside_)
        beside_->post(std::move(step));
    else
        step();
}

void Session::passWarningsOn()
{
    if (!beside_) return;
    std::vector<Warning> told;
    {
        const std::lock_guard lock(mapper_warnings_mutex_);
        told.swap(mapper_warnings_);
    }
    for (const Warning& w : told) warnings_.add(w);
}

void Session::write(const Event& event)
{
    if (const auto* estimated = std::get_if<Estimated>(&event))
    {
        const ScanResult& result = estimated->result;
        const NavState& x = result.estimate.state;
        metrics_.add(result);
        files_.add(result);
        covariance_ = result.estimate.covariance;
        if (!config_.method.refined)
        {
            path_->add({x.t, x.T_world_imu});
            map_->add(x, result.points, result.sweep.scan);
        }
    }
    else if (const auto* refined = std::get_if<Refined>(&event))
    {
        takeRefined(*refined);
    }
    else if (mapper_)
    {
        // What the IMU alone bridges is in the covariance; a wrong match is not.
        const auto* lost = std::get_if<Lost>(&event);
        if (lost != nullptr && lost->cause == "pose_doubtful")
            tellMapper([this] { mapper_->setDoubt(true); });
        if (std::holds_alternative<Recovered>(event))
            tellMapper([this] { mapper_->setDoubt(false); });
    }
}

void Session::takeRefined(const Refined& refined)
{
    const bool for_files = config_.method.refined;
    if (!for_files && !mapper_) return;
    const NavState& x = refined.state;
    std::vector<Vector3d> points = refined.points();
    if (for_files)
    {
        path_->add({x.t, x.T_world_imu});
        map_->add(x, points, refined.sweep.scan);
    }
    if (!mapper_) return;
    if (records_.empty())
        tellMapper(
            [this, first = NavEstimate{
                       refined.sweep.begin, pipeline_.initialization()->estimate.covariance}] {
                mapper_->start(first);
            });
    tellMapper([this, estimate = NavEstimate{x, covariance_}, points = std::move(points),
                T_imu_lidar = refined.sweep.T_imu_lidar]
               { mapper_->add(estimate, points, T_imu_lidar); });
    records_.emplace_back(refined.sweep, x);
}

SessionOutcome Session::run(
    MeasurementStream& log, const std::function<bool(double)>& go_on, Reopen reopen)
{
    bool interrupted = false;
    reopen_ = std::move(reopen);
    go_on_ = go_on;
    const auto begin = std::chrono::steady_clock::now();
    attempt([&] { interrupted = !processAll(log, go_on); });
    wall_seconds_ = secondsSince(begin) - (config_.live ? idle_seconds_ : 0);
    return finish(log.progress(), log.incomplete(), interrupted);
}

/** False: it was interrupted. */
bool Session::processAll(MeasurementStream& log, const std::function<bool(double)>& go_on)
{
    const auto next = [&]
    {
        const auto begin = std::chrono::steady_clock::now();
        std::optional<Measurement> m = log.next();
        idle_seconds_ += secondsSince(begin);
        return m;
    };
    while (std::optional<Measurement> m = next())
    {
        add(std::move(*m));
        if (!go_on(log.progress().fraction())) return false;
    }
    pipeline_.finish();
    return true;
}

/** One of the things that are done whatever became of the others. The first error is the cause,
 * what comes of it is a warning. */
void Session::attempt(const std::function<void()>& step)
{
    try
    {
        step();
    }
    catch (const std::exception& e)
    {
        if (failure_.empty())
            failure_ = e.what();
        else if (failure_ != e.what())
            warnings_.add({0, "not_saved", e.what()});
    }
}

SessionOutcome Session::finish(const StreamProgress& log, bool incomplete, bool interrupted)
{
    SessionOutcome outcome;
    // Where the disk took no more, what the pipeline still holds back has no place either.
    if (written_) attempt([&] { pipeline_.finish(); });
    if (beside_) attempt([&] { beside_->drain(); });
    passWarningsOn();
    beside_.reset();
    attempt([&] { path_->close(); });
    attempt([&] { files_.close(); });
    attempt([&] { map_->finish(warnings_.sink()); });
    if (interrupted) reopen_ = {};
    attempt([&] { closeLoops(); });
    interrupted |= interrupted_again_;
    outcome.interrupted = interrupted;
    outcome.poses = path_->poses();
    outcome.pictures_failed = config_.pictures && outcome.poses > 0 && !drawPictures();
    reserve_->release();
    attempt([&] { writeMetrics(log, incomplete, interrupted); });
    outcome.report_failed = config_.report && !writePage();
    outcome.failure = failure_;
    outcome.length = path_->length();
    outcome.duration = metrics_.duration();
    outcome.wall_seconds = wall_seconds_;
    outcome.milliseconds_a_scan = metrics_.meanMilliseconds();
    outcome.map_points = map_->points();
    if (mapper_) outcome.submaps = mapper_->submaps();
    if (mapper_) outcome.loops = mapper_->accepted();
    if (mapper_) outcome.corrected = mapper_->moved();
    outcome.undistorted_again = undistorted_again_;
    outcome.partly = interrupted || usedPartly(log, incomplete);
    if (watch_) outcome.live = watch_->summary();
    return outcome;
}

void Session::closeLoops()
{
    if (!mapper_) return;
    const double slam_before = mapper_->seconds();
    mapper_->finish();
    wall_seconds_ += mapper_->seconds() - slam_before;
    const fs::path folder = config_.folder;
    fs::copy_file(
        path_->tumPath(), folder / "trajectory_odometry.tum", fs::copy_options::overwrite_existing);
    writeG2o((folder / "graph.g2o").string(), mapper_->resultGraph());
    writeLoops((folder / "loops.csv").string(), mapper_->loops());
    mapper_->writeClouds();
    writeSimpleMap((folder / "map.simplemap").string(), *mapper_);
    if (mapper_->moved()) takeCorrectedPath();
    takeOutMovedThings();
}

void Session::takeCorrectedPath()
{
    const auto begin = std::chrono::steady_clock::now();
    std::vector<StampedPose> path;
    mapper_->forPath(
        mapper_->ownRun(),
        [&](Time t, const Pose& pose) {
            path.push_back({t, pose});
        });
    rewriteAlong(path);
    second_pass_seconds_ = secondsSince(begin);
}

/* What was there and has gone is left out of the map. */
void Session::takeOutMovedThings()
{
    const auto begin = std::chrono::steady_clock::now();
    moved_points_ = taut::takeOutMovedThings(*mapper_, *map_, executor_);
    moved_seconds_ = secondsSince(begin);
}

void Session::rewriteAlong(const std::vector<StampedPose>& path)
{
    const fs::path folder = config_.folder;
    auto corrected_path = std::make_unique<PathFiles>(config_.folder, ".part");
    std::vector<Pose> poses;
    for (const StampedPose& stamped : path) poses.push_back(stamped.T_world_imu);
    for (std::size_t i = 1; i < path.size(); i++) corrected_path->add(path[i]);
    corrected_path->close();
    fs::rename(corrected_path->tumPath(), path_->tumPath());
    fs::rename(corrected_path->kittiPath(), path_->kittiPath());
    path_ = std::move(corrected_path);

    const fs::path beside = folder / "map.part";
    const auto anew = [&]
    {
        fs::create_directories(beside);
        return std::make_unique<MapExport>(config_.method.map_export, beside.string());
    };
    std::unique_ptr<MapExport> map = anew();
    second_pass_ = true;
    undistorted_again_ = reopen_ && streamAgain(corrected(records_, poses), *map);
    if (!undistorted_again_)
    {
        map = anew();
        moveSubmaps(*mapper_, mapper_->ownRun(), poses, *map);
    }
    map->finish(warnings_.sink());
    map->moveTo(config_.folder);
    fs::remove(beside);
    map_ = std::move(map);
}

bool Session::streamAgain(const std::vector<SweepRecord>& records, MapExport& map)
{
    try
    {
        const bool whole =
            undistortAgain(*reopen_(), config_.method.odometry, records, map, go_on_);
        interrupted_again_ = !whole;
        return whole;
    }
    catch (const std::exception& e)
    {
        warnings_.add(
            {0, "no_second_pass",
             std::string("the points of the submaps are moved instead: ") + e.what()});
        return false;
    }
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
            "%.1f m, %.1f s, %d scans, undistortion: %s", path_->length(), metrics_.duration(),
            path_->poses(), nameOf(config_.method.odometry.estimation.undistortion))};
}

bool Session::drawPictures() const
{
    RenderScene scene{map_->sample(), path_->sample(), caption()};
    if (mapper_) scene.loops = mapper_->joinedPlaces();
    return drawViews(config_.method.renderer, scene, config_.folder, warnings_);
}

bool Session::writePage() const
{
    try
    {
        const Report page = readRunReport(config_.folder, config_.truth, warnings_.sink());
        writeReport(page, (fs::path(config_.folder) / "report.html").string());
        return true;
    }
    catch (const std::exception& e)
    {
        warnings_.add({0, "no_report", e.what()});
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
    s.length = path_->length();
    s.map_points = map_->points();
    s.map_cells = pipeline_.mapSize();
    s.key_scans = map_->keyScans();
    s.occupancy_resolution = map_->occupancyResolution();
    s.mode = nameOf(config_.method.odometry.estimation.undistortion);
    s.method_file = config_.method_file;
    s.threads = config_.threads;
    s.wall_seconds = wall_seconds_;
    s.doubts = doubts_.all();
    if (watch_) s.live = watch_->summary();
    s.with_slam = mapper_ != nullptr;
    s.second_pass = undistorted_again_;
    s.second_pass_seconds = second_pass_seconds_;
    s.moved_points = moved_points_;
    s.moved_seconds = moved_seconds_;
    if (mapper_)
    {
        const auto count = [this](Verdict verdict)
        {
            const auto& loops = mapper_->loops();
            return static_cast<std::size_t>(std::count_if(
                loops.begin(), loops.end(),
                [&](const LoopClosure& loop) { return loop.verdict == verdict; }));
        };
        s.submaps = mapper_->submaps();
        s.loops_judged = mapper_->loops().size();
        s.loops_accepted = count(Verdict::Accepted);
        s.loops_pending = count(Verdict::Pending);
        s.loops_withdrawn = count(Verdict::Withdrawn);
        s.path_corrected = mapper_->moved();
        s.drift_scale = mapper_->scaleOfDrift();
        s.slam_seconds = mapper_->seconds();
    }
    writeText(fs::path(config_.folder) / "metrics.json", metrics_.json(s, warnings_));
}
}  // namespace taut
