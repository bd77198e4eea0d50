#include "taut/session/RunReport.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "CsvRows.h"
#include "RunAccuracy.h"
#include "RunPlots.h"
#include "taut/core/ThinnedSample.h"
#include "taut/core/TimeText.h"
#include "taut/core/format.h"
#include "taut/files/PlyFile.h"
#include "taut/graph/G2oFile.h"
#include "taut/submaps/SubmapStore.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace fs = std::filesystem;

namespace taut
{
namespace
{
using Json = nlohmann::json;

constexpr std::size_t kMostPoints = 2'000'000;  // read; how many go to the page is its own affair
constexpr std::size_t kMostLoopPlaces = 400;    // submaps that are read for the times of loops

std::string textOf(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

Time timeOf(const Json& seconds)
{
    constexpr double kLatest = 4e9;  // [s], the year 2096
    const double t = seconds.get<double>();
    if (!(std::abs(t) <= kLatest)) throw std::runtime_error("a time in it is none");
    return fromSeconds(t);
}

std::size_t countOf(const Json& number)
{
    constexpr double kMost = 1e15;
    const double n = number.get<double>();
    if (!(n >= 0 && n <= kMost)) throw std::runtime_error("a number of warnings in it is none");
    return static_cast<std::size_t>(n);
}

/** A number of metrics.json in words; nothing if it is not there. */
std::optional<double> numberAt(const Json& metrics, const char* pointer)
{
    const Json::json_pointer at(pointer);
    if (!metrics.contains(at) || !metrics[at].is_number()) return {};
    return metrics[at].get<double>();
}

/** A text of metrics.json; empty if it is not there. */
std::string textAt(const Json& metrics, const char* pointer)
{
    const Json::json_pointer at(pointer);
    return metrics.contains(at) && metrics[at].is_string() ? metrics[at].get<std::string>() : "";
}

/** Rows of a table out of metrics.json, of what is there. */
class Facts
{
 public:
    Facts(const Json& metrics, const std::string& title)
        : metrics_(metrics), table_{title, "", {}, {}}
    {
    }

    Facts& number(const char* name, const char* pointer, const char* text, double factor = 1)
    {
        if (const auto value = numberAt(metrics_, pointer))
            table_.rows.push_back({name, format(text, factor * *value)});
        return *this;
    }
    Facts& text(const char* name, const char* pointer)
    {
        const Json::json_pointer at(pointer);
        if (metrics_.contains(at) && metrics_[at].is_string())
            table_.rows.push_back({name, metrics_[at].get<std::string>()});
        return *this;
    }
    Facts& yes(const char* name, const char* pointer)
    {
        const Json::json_pointer at(pointer);
        if (metrics_.contains(at) && metrics_[at].is_boolean())
            table_.rows.push_back({name, metrics_[at].get<bool>() ? "yes" : "no"});
        return *this;
    }
    const ReportTable& table() const { return table_; }

 private:
    const Json& metrics_;
    ReportTable table_;
};

std::vector<ReportTable> factsOf(const Json& metrics)
{
    return {
        Facts(metrics, "Recording")
            .text("file", "/input/file")
            .number("duration", "/input/duration_s", "%.2f s")
            .text("LiDAR", "/input/lidar_label")
            .text("IMU", "/input/imu_label")
            .number("scans", "/input/scans", "%.0f")
            .number("IMU samples", "/input/imu_samples", "%.0f")
            .number("skipped observations", "/input/skipped_observations", "%.0f")
            .yes("ends early", "/input/incomplete")
            .text("SHA-256", "/input/sha256")
            .table(),
        Facts(metrics, "Estimation")
            .text("undistortion", "/method/undistortion")
            .yes("with an IMU", "/method/with_imu")
            .number("rest at the start", "/method/rest_s", "%.2f s")
            .number("of the recording", "/result/coverage", "%.1f %%", 100)
            .number("scans without matches", "/result/unmatched_scans", "%.0f")
            .number("scans that did not converge", "/result/not_converged_scans", "%.0f")
            .number("iterations a scan", "/result/mean_iterations", "%.2f")
            .number("matches a scan", "/result/mean_correspondences", "%.0f")
            .yes("interrupted", "/result/interrupted")
            .table(),
        Facts(metrics, "Map and loops")
            .number("points in map.ply", "/map/points", "%.0f")
            .number("cell of the occupancy map", "/map/occupancy_resolution_m", "%.2f m")
            .number("submaps", "/slam/submaps", "%.0f")
            .number("pairs of submaps judged", "/slam/loops_judged", "%.0f")
            .number("loops believed", "/slam/loops_accepted", "%.0f")
            .number("loops pending", "/slam/loops_pending", "%.0f")
            .number("loops withdrawn", "/slam/loops_withdrawn", "%.0f")
            .yes("path corrected", "/slam/path_corrected")
            .yes("points undistorted again", "/slam/undistorted_again")
            .table(),
        Facts(metrics, "Computing")
            .number("time a scan, mean", "/time/mean_ms_per_scan", "%.1f ms")
            .number("time a scan, longest", "/time/max_ms_per_scan", "%.1f ms")
            .number("whole run", "/time/wall_s", "%.1f s")
            .number("times real time", "/time/times_real_time", "%.2f")
            .number("threads", "/method/threads", "%.0f")
            .number("memory, highest", "/memory/peak_mb", "%.0f MB")
            .text("version of taut", "/program/version")
            .table()};
}

/** Reads a folder's results into a report, one after another. */
class Reader
{
 public:
    Reader(const std::string& folder, const Trajectory& truth, const WarningSink& warn)
        : folder_(folder), truth_(truth), warn_(warn)
    {
    }

    Report read()
    {
        requireFile("trajectory.tum");
        path_ = readTum((folder_ / "trajectory.tum").string());
        readPath();
        use("metrics.json", [this] { readMetrics(); });
        use("map.ply", [this] { readPoints(); });
        report_.plots = motionPlots(path_);
        use("states.csv", [this] { append(statePlots((folder_ / "states.csv").string())); });
        use("timing.csv", [this] { append(timingPlots((folder_ / "timing.csv").string())); });
        use("loops.csv", [this] { readLoops(); });
        for (const char* name : {"config.yaml", "rig.yaml"})
            use(name, [&] { report_.texts.emplace_back(name, textOf(folder_ / name)); });
        if (!truth_.empty()) report_.accuracy = accuracyOf(truth_, path_);
        setHeadlines();
        return std::move(report_);
    }

 private:
    /** A device or a pipe may never end. */
    void requireFile(const char* name) const
    {
        if (fs::exists(folder_ / name) && !fs::is_regular_file(folder_ / name))
            throw std::runtime_error("'" + (folder_ / name).string() + "' is no file");
    }

    /** Reads a result if it is there; what is wrong with it is a warning. */
    template <class Function>
    void use(const char* name, Function&& function)
    {
        if (!fs::exists(folder_ / name)) return;
        try
        {
            requireFile(name);
            function();
        }
        catch (const std::exception& e)
        {
            note({0, "report_incomplete", std::string(name) + " is left out: " + e.what()});
        }
    }

    void note(const Warning& warning)
    {
        report_.warnings.push_back({warning.kind, 1, {warning}});
        if (warn_) warn_(warning);
    }

    void append(std::vector<ReportPlot> plots)
    {
        for (ReportPlot& plot : plots) report_.plots.push_back(std::move(plot));
    }

    void readPath()
    {
        ThinnedSample<ReportPose> sample(kMostSamples);
        for (const StampedPose& pose : path_) sample.add({pose.t, pose.T_world_imu});
        report_.path = sample.items();
        if (!path_.empty() && report_.path.back().t != path_.back().t)
            report_.path.push_back({path_.back().t, path_.back().T_world_imu});
    }

    /** A list of metrics.json; an empty one where it has none. */
    const Json& listOf(const char* name) const
    {
        static const Json none = Json::array();
        const auto at = metrics_.find(name);
        return at == metrics_.end() ? none : *at;
    }

    void readMetrics()
    {
        Json metrics = Json::parse(textOf(folder_ / "metrics.json"));
        if (!metrics.is_object()) throw std::runtime_error("it is no object");
        metrics_ = std::move(metrics);
        report_.facts = factsOf(metrics_);
        for (const Json& d : listOf("doubtful"))
            report_.stretches.push_back(
                {timeOf(d.at("from")), timeOf(d.at("to")), d.at("cause").get<std::string>(),
                 d.at("recovered").get<bool>()});
        for (const auto& [kind, count] : listOf("warnings").items())
            report_.warnings.push_back({kind, countOf(count), {}});
        for (const Json& w : listOf("first_warnings"))
            for (ReportWarnings& kind : report_.warnings)
                if (kind.kind == w.at("kind").get<std::string>())
                    kind.first.push_back(
                        {timeOf(w.at("t")), kind.kind, w.at("text").get<std::string>()});
    }

    void readPoints()
    {
        PlyReader ply((folder_ / "map.ply").string());
        const int x = ply.column("x"), y = ply.column("y"), z = ply.column("z");
        const int intensity = ply.column("intensity");
        if (x < 0 || y < 0 || z < 0) throw std::runtime_error("it has no x, y and z");
        ThinnedSample<ReportPoint> sample(kMostPoints);
        const auto value = [](const std::vector<double>& row, int column)
        { return column < 0 ? 0.f : static_cast<float>(row[static_cast<std::size_t>(column)]); };
        for (std::vector<double> row; ply.next(row);)
            sample.add({{value(row, x), value(row, y), value(row, z)}, value(row, intensity)});
        report_.points = sample.items();
    }

    /** Where and when each submap began that a loop names. */
    struct Place
    {
        Time t = 0;
        Vector3d p = Vector3d::Zero();
    };

    void readLoops()
    {
        CsvRows csv((folder_ / "loops.csv").string());
        std::vector<std::vector<std::string>> rows;
        for (std::vector<std::string> row; csv.next(row);) rows.push_back(row);
        const auto at = [&](const std::vector<std::string>& row, const char* name)
        {
            const int column = csv.column(name);
            if (column < 0) throw std::runtime_error(std::string("it has no ") + name);
            return row[static_cast<std::size_t>(column)];
        };
        std::set<VertexId> wanted;
        for (const char* verdict : {"accepted", "withdrawn", "pending", "refused"})
            for (const auto& row : rows)
                if (at(row, "verdict") == verdict && wanted.size() < kMostLoopPlaces)
                    wanted.insert({std::stoll(at(row, "from")), std::stoll(at(row, "to"))});
        const std::map<VertexId, Place> places = placesOf(wanted);
        for (const auto& row : rows)
        {
            const auto from = places.find(std::stoll(at(row, "from")));
            const auto to = places.find(std::stoll(at(row, "to")));
            if (from == places.end() || to == places.end()) continue;
            report_.loops.push_back(
                {"submaps " + at(row, "from") + " and " + at(row, "to"), at(row, "verdict"),
                 at(row, "reason"), at(row, "verdict") == "accepted", from->second.t, to->second.t,
                 from->second.p, to->second.p, std::strtod(at(row, "gap_m").c_str(), nullptr)});
        }
    }

    std::map<VertexId, Place> placesOf(const std::set<VertexId>& wanted)
    {
        std::map<VertexId, Place> places;
        if (wanted.empty()) return places;
        const SubmapStore store((folder_ / "submaps").string(), 1);
        for (const GraphVertex& vertex : readG2o((folder_ / "graph.g2o").string()).vertices)
            if (wanted.count(vertex.id) > 0 && fs::exists(store.fileOf(vertex.id)))
                places[vertex.id] = {store.at(vertex.id)->scans.front().t, vertex.T_world_submap.p};
        return places;
    }

    void setHeadlines()
    {
        const std::string input = textAt(metrics_, "/input/file");
        report_.title = fs::path(input).filename().string();
        if (report_.title.empty()) report_.title = fs::absolute(folder_).filename().string();
        report_.subtitle = "Run of taut in " + folder_.string();
        if (!path_.empty())
            report_.subtitle += ", from " + formatSeconds(path_.front().t) + " s (UNIX time)";
        const auto add = [this](const char* name, const std::string& value)
        { report_.headlines.emplace_back(name, value); };
        add("way", format("%.1f m", pathLength(path_)));
        add("duration",
            format("%.1f s", path_.empty() ? 0 : toSeconds(path_.back().t - path_.front().t)));
        add("scans", std::to_string(path_.size()));
        if (const auto ms = numberAt(metrics_, "/time/mean_ms_per_scan"))
            add("a scan took", format("%.1f ms", *ms));
        if (const auto loops = numberAt(metrics_, "/slam/loops_accepted"))
            add("loops", format("%.0f", *loops));
        std::size_t warnings = 0;
        for (const ReportWarnings& kind : report_.warnings) warnings += kind.count;
        add("warnings", std::to_string(warnings));
        double doubtful = 0;
        for (const ReportStretch& s : report_.stretches) doubtful += toSeconds(s.to - s.from);
        add("in doubt", format("%.1f s", doubtful));
    }

    fs::path folder_;
    const Trajectory& truth_;
    const WarningSink& warn_;
    Trajectory path_;
    Json metrics_ = Json::object();
    Report report_;
};
}  // namespace

Report readRunReport(const std::string& folder, const Trajectory& truth, const WarningSink& warn)
{
    return Reader(folder, truth, warn).read();
}
}  // namespace taut
