#include "RunPlots.h"

#include <cmath>
#include <cstdlib>

#include "CsvRows.h"
#include "taut/core/ThinnedSample.h"
#include "taut/core/TimeText.h"
#include "taut/trajectory/Statistics.h"

namespace taut
{
namespace
{
/** Columns of a table over its first one, the time; evenly thinned where it is long. */
class Table
{
 public:
    explicit Table(const std::string& path) : csv_(path)
    {
        ThinnedSample<std::vector<double>> sample(kMostSamples);
        ThinnedSample<Time> times(kMostSamples);
        for (std::vector<std::string> row; csv_.next(row);)
        {
            std::vector<double> values;
            for (const std::string& word : row)
                values.push_back(std::strtod(word.c_str(), nullptr));
            sample.add(values);
            times.add(parseSeconds(row.front()));
        }
        rows_ = sample.items();
        times_ = times.items();
    }

    const std::vector<Time>& times() const { return times_; }

    bool has(const std::string& name) const { return csv_.column(name) >= 0; }

    std::vector<float> column(const std::string& name, double factor = 1) const
    {
        std::vector<float> values;
        const int at = csv_.column(name);
        if (at < 0) return std::vector<float>(rows_.size(), std::nanf(""));
        for (const auto& row : rows_)
            values.push_back(static_cast<float>(factor * row[static_cast<std::size_t>(at)]));
        return values;
    }

    /** Three standard deviations of a column of variances. */
    std::vector<float> threeSigma(const std::string& name, double factor = 1) const
    {
        std::vector<float> values = column(name);
        for (float& v : values) v = static_cast<float>(factor * 3) * std::sqrt(v);
        return values;
    }

 private:
    CsvRows csv_;
    std::vector<std::vector<double>> rows_;
    std::vector<Time> times_;
};

ReportPlot plotOver(
    const Table& table, const std::string& title, const std::string& unit, const std::string& hint)
{
    return {title, unit, hint, false, table.times(), {}};
}

ReportPlot biasPlot(
    const Table& table, const std::string& sensor, const std::string& key, const std::string& unit,
    double factor)
{
    ReportPlot plot = plotOver(
        table, sensor + " bias", unit, "Settles and stays; the band is three standard deviations.");
    for (const char* axis : {"x", "y", "z"})
        plot.curves.push_back(
            {axis, table.column(key + "_" + axis, factor),
             table.threeSigma("var_" + key + "_" + axis, factor)});
    return plot;
}

ReportPlot sigmaPlot(
    const Table& table, const std::string& title, const std::string& key, const std::string& unit,
    double factor)
{
    ReportPlot plot = plotOver(table, title, unit, "Three standard deviations, as estimated.");
    plot.logarithmic = true;
    for (const char* axis : {"x", "y", "z"})
        plot.curves.push_back({axis, table.threeSigma("var_" + key + "_" + axis, factor), {}});
    return plot;
}

ReportPlot informationPlot(
    const Table& table, const std::string& what, const std::string& key, const std::string& unit)
{
    ReportPlot plot = plotOver(
        table, "Information on the " + what, unit,
        "Of the LiDAR along its weakest, middle and best axis. A weak one that falls is a "
        "direction "
        "without structure.");
    plot.logarithmic = true;
    int axis = 1;
    for (const char* name : {"weakest", "middle", "best"})
        plot.curves.push_back(
            {name, table.column(key + "_information_" + std::to_string(axis++)), {}});
    return plot;
}
}  // namespace

std::vector<ReportPlot> motionPlots(const Trajectory& path)
{
    ReportPlot speed{"Speed", "m/s", "From pose to pose.", false, {}, {{"speed", {}, {}}}};
    ReportPlot turn{"Turn rate", "deg/s", "From pose to pose.", false, {}, {{"rate", {}, {}}}};
    const std::size_t stride = 1 + path.size() / kMostSamples;
    for (std::size_t i = 1; i < path.size(); i += stride)
    {
        const StampedPose &a = path[i - 1], &b = path[i];
        const double seconds = toSeconds(b.t - a.t);
        const Pose moved = a.T_world_imu.inverse() * b.T_world_imu;
        speed.curves[0].values.push_back(static_cast<float>(moved.p.norm() / seconds));
        turn.curves[0].values.push_back(
            static_cast<float>(angleOf(moved.R) * kDegreesPerRadian / seconds));
        speed.times.push_back(b.t);
    }
    turn.times = speed.times;
    return {speed, turn};
}

std::vector<ReportPlot> statePlots(const std::string& states_csv)
{
    const Table table(states_csv);
    ReportPlot matches =
        plotOver(table, "Matches", "", "Features of a scan, and those that found a surface.");
    matches.curves = {
        {"features", table.column("features"), {}},
        {"matched", table.column("correspondences"), {}}};
    std::vector<ReportPlot> plots{matches};
    if (table.has("fit"))
    {
        plots.push_back(plotOver(
            table, "Fit", "",
            "Share of the matches that their surfaces explain. A drop is doubt."));
        plots.back().curves = {{"fit", table.column("fit"), {}}};
        for (std::size_t i = 0; i < table.times().size(); i++)  // nothing to fit
            if (!(matches.curves[1].values[i] > 0))
                plots.back().curves[0].values[i] = std::nanf("");
    }
    plots.push_back(plotOver(table, "Iterations", "", "Look-ups of matches a scan."));
    plots.back().curves = {{"iterations", table.column("iterations"), {}}};
    plots.push_back(biasPlot(table, "Accelerometer", "ba", "m/s\u00B2", 1));
    plots.push_back(biasPlot(table, "Gyroscope", "bg", "deg/s", kDegreesPerRadian));
    plots.push_back(sigmaPlot(table, "Uncertainty of the position", "p", "m", 1));
    plots.push_back(
        sigmaPlot(table, "Uncertainty of the attitude", "theta", "deg", kDegreesPerRadian));
    plots.push_back(informationPlot(table, "position", "translation", "1/m\u00B2"));
    plots.push_back(informationPlot(table, "attitude", "rotation", "1/rad\u00B2"));
    return plots;
}

std::vector<ReportPlot> timingPlots(const std::string& timing_csv)
{
    const Table table(timing_csv);
    ReportPlot times =
        plotOver(table, "Time of computing", "ms a scan", "All stages and the longest of them.");
    for (const char* stage : {"total", "match", "solve", "insert"})
        times.curves.push_back({stage, table.column(std::string(stage) + "_ms"), {}});
    ReportPlot points = plotOver(table, "Points", "a scan", "In range, and used.");
    points.curves = {{"points", table.column("points"), {}}};
    return {times, points};
}
}  // namespace taut
