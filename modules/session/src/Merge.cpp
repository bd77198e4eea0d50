#include "taut/session/Merge.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "drawViews.h"
#include "takeOutMovedThings.h"
#include "taut/core/format.h"
#include "taut/graph/G2oFile.h"
#include "taut/session/MapExport.h"
#include "taut/session/ResultFiles.h"
#include "taut/session/SecondPass.h"
#include "taut/slam/LoopsFile.h"
#include "taut/slam/Mapper.h"
#include "taut/slam/SimpleMapFile.h"

namespace fs = std::filesystem;

namespace taut
{
namespace
{
/** Runs that are joined so far: a mapper, and where its graph and submaps are on the disk. */
struct Joined
{
    std::unique_ptr<Mapper> mapper;  // none as long as there is one run alone
    std::string folder;
    std::vector<std::string> runs;
    std::vector<LoopClosure> loops;  // judged on the way, of all steps
};

class Merge
{
 public:
    Merge(const MergeConfig& config, WarningLog& warnings)
        : config_(config),
          warnings_(warnings),
          executor_(config.threads),
          steps_(fs::path(config.folder) / "merge.part")
    {
        fs::remove_all(steps_);
    }
    ~Merge()
    {
        std::error_code ignored;
        fs::remove_all(steps_, ignored);
    }
    Merge(const Merge&) = delete;
    Merge& operator=(const Merge&) = delete;

    MergeOutcome run()
    {
        Joined joined{nullptr, config_.folders.at(0), {config_.folders.at(0)}, {}};
        std::vector<std::string> left(config_.folders.begin() + 1, config_.folders.end());
        // A run that shares no place with those that are joined so far may share one with others.
        for (bool progress = true; progress && !left.empty();)
        {
            const std::size_t before = left.size();
            const auto is_joined = [&](const std::string& run) { return tryToJoin(joined, run); };
            left.erase(std::remove_if(left.begin(), left.end(), is_joined), left.end());
            progress = left.size() < before;
        }
        for (const std::string& run : left)
            warnings_.add(
                {0, "place_unknown", "no place of '" + run + "' was recognised in the others"});
        if (!joined.mapper)
            throw std::runtime_error("no place was recognised that two of the runs share");
        return write(joined, left);
    }

 private:
    bool tryToJoin(Joined& joined, const std::string& run)
    {
        const fs::path folder = steps_ / std::to_string(step_++);
        auto mapper = std::make_unique<Mapper>(
            config_.method.slam, (folder / "submaps").string(), executor_, WarningSink());
        mapper->use({joined.folder, true, {}});
        mapper->addRun(run);
        mapper->finish();
        if (mapper->isApart())
        {
            fs::remove_all(folder);
            return false;
        }
        writeG2o((folder / "graph.g2o").string(), mapper->resultGraph());
        const auto& loops = mapper->loops();
        joined.loops.insert(joined.loops.end(), loops.begin(), loops.end());
        joined.mapper = std::move(mapper);
        joined.folder = folder.string();
        joined.runs.push_back(run);
        return true;
    }

    MergeOutcome write(const Joined& joined, const std::vector<std::string>& apart)
    {
        const fs::path folder = config_.folder;
        Mapper& mapper = *joined.mapper;
        MergeOutcome outcome;
        outcome.apart = apart;
        outcome.submaps = mapper.resultGraph().vertices.size();
        outcome.loops = static_cast<std::size_t>(std::count_if(
            joined.loops.begin(), joined.loops.end(),
            [](const LoopClosure& loop) { return loop.verdict == Verdict::Accepted; }));
        writeG2o((folder / "graph.g2o").string(), mapper.resultGraph());
        writeLoops((folder / "loops.csv").string(), joined.loops);
        mapper.writeClouds();
        writeSimpleMap((folder / "map.simplemap").string(), mapper);
        MapExport map(config_.method.map_export, config_.folder);
        ThinnedSample<Pose> path(100'000);
        for (const Mapper::Run& run : mapper.runs())
            writeRun(mapper, run, ++outcome.runs, map, path);
        map.finish(warnings_.sink());
        takeOutMovedThings(mapper, map, executor_);
        outcome.map_points = map.points();
        if (config_.pictures) outcome.pictures_failed = !draw(mapper, map, path);
        // At last: the mapper reads them where they are.
        fs::rename(fs::path(joined.folder) / "submaps", folder / "submaps");
        writeMetrics(joined, outcome);
        return outcome;
    }

    void writeRun(
        const Mapper& mapper, const Mapper::Run& run, std::size_t number, MapExport& map,
        ThinnedSample<Pose>& sample)
    {
        std::vector<Pose> poses;
        TumWriter file(
            (fs::path(config_.folder) / ("trajectory_" + std::to_string(number) + ".tum"))
                .string());
        mapper.forPath(
            run,
            [&](Time t, const Pose& pose)
            {
                if (!poses.empty()) file.write({t, pose});  // the first is before the first scan
                poses.push_back(pose);
                sample.add(pose);
            });
        file.close();
        moveSubmaps(mapper, run, poses, map);
    }

    bool draw(const Mapper& mapper, const MapExport& map, const ThinnedSample<Pose>& path)
    {
        const std::string caption = format("%zu runs", mapper.runs().size());
        return drawViews(
            config_.method.renderer, {map.sample(), path.items(), {caption}, mapper.joinedPlaces()},
            config_.folder, warnings_);
    }

    void writeMetrics(const Joined& joined, const MergeOutcome& outcome) const
    {
        nlohmann::ordered_json json;
        json["program"] = {{"name", "taut-merge"}, {"version", TAUT_VERSION}};
        json["runs"] = joined.runs;
        json["apart"] = outcome.apart;
        json["submaps"] = outcome.submaps;
        json["loops"] = {{"judged", joined.loops.size()}, {"accepted", outcome.loops}};
        json["map_points"] = outcome.map_points;
        json["seconds"] = std::chrono::duration<double>(Clock::now() - begin_).count();
        std::ofstream file(fs::path(config_.folder) / "metrics.json");
        file << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
        if (!file.flush()) throw std::runtime_error("cannot write metrics.json");
    }

    using Clock = std::chrono::steady_clock;

    const MergeConfig& config_;
    WarningLog& warnings_;
    Executor executor_;
    fs::path steps_;  // one folder for each run that is tried
    int step_ = 0;
    Clock::time_point begin_ = Clock::now();
};
}  // namespace

MergeOutcome mergeRuns(const MergeConfig& config, WarningLog& warnings)
{
    return Merge(config, warnings).run();
}
}  // namespace taut
