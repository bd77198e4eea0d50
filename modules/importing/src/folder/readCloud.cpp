#include "readCloud.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "../TimeField.h"
#include "../intensityScale.h"
#include "CsvReader.h"
#include "taut/files/PcdFile.h"
#include "taut/files/PlyFile.h"
#include "taut/rawlog/ScanBuilder.h"

namespace taut
{
namespace
{
constexpr double kWorstBadShare = 0.05;  // of the points of a scan
constexpr double kLatest = 4e18;  // [ns], the year 2096: sums and differences do not overflow
constexpr double kMostRings = 65536;
constexpr double kFar = 1e9;  // [ns] from the usual time of a sweep: none of it
constexpr std::size_t kCloudsToJudge = 10;

/** Any of the three kinds of file. */
struct Table
{
    std::vector<std::string> columns;
    std::function<bool(std::vector<double>&)> next;
};

template <class Reader>
Table open(const std::string& path)
{
    const auto reader = std::make_shared<Reader>(path);
    return {reader->columns(), [reader](std::vector<double>& row) { return reader->next(row); }};
}

std::string endingOf(const std::filesystem::path& file)
{
    std::string ending = file.extension().string();
    std::transform(
        ending.begin(), ending.end(), ending.begin(),
        [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

Table openTable(const std::filesystem::path& file)
{
    const std::string ending = endingOf(file), path = file.string();
    if (ending == ".ply") return open<PlyReader>(path);
    if (ending == ".pcd") return open<PcdReader>(path);
    return open<CsvReader>(path);
}

/** Column of the first of these names that is there; -1 if none is. */
int columnOf(const Table& table, const std::vector<std::string>& names)
{
    for (const auto& name : names)
    {
        const auto it = std::find(table.columns.begin(), table.columns.end(), name);
        if (it != table.columns.end()) return static_cast<int>(it - table.columns.begin());
    }
    return -1;
}

/** How a file tells the times of its points. */
struct TimeColumn
{
    int column = -1;  // -1: it does not
    double unit = 1;  // [ns]
    RawCloud::Times kind = RawCloud::Times::None;
};

TimeColumn timeColumnOf(const Table& table, const std::string& asked)
{
    using Times = RawCloud::Times;
    TimeColumn found;
    for (const auto& [name, unit, kind] :
         {std::tuple("t", 1e9, Times::Absolute), std::tuple("t_ns", 1.0, Times::Absolute),
          std::tuple("dt", 1e9, Times::SinceStamp), std::tuple("dt_ns", 1.0, Times::SinceStamp)})
    {
        const int column = columnOf(table, {name});
        if (column < 0 || (!asked.empty() && asked != name)) continue;
        if (found.column >= 0)
            throw std::runtime_error("has more than one column of times: t, t_ns, dt or dt_ns");
        found = {column, unit, kind};
    }
    if (found.column >= 0) return found;
    try
    {
        found.column = timeFieldOf(table.columns, asked);
    }
    catch (const std::runtime_error& e)
    {
        throw bag::FieldError(e.what());
    }
    if (found.column >= 0) found.kind = Times::Judged;
    return found;
}

double median(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/** Whether the values may have been 32-bit floats. */
bool isSinglePrecision(const std::vector<double>& values)
{
    return std::all_of(
        values.begin(), values.end(),
        [](double v)
        { return !std::isfinite(v) || static_cast<double>(static_cast<float>(v)) == v; });
}

/** Times of today as 32-bit floats are the same for a minute and more. */
void checkPrecision(const std::vector<double>& times, double unit)
{
    constexpr double kExact = 1e5;  // [s] up to which a float tells 10 ms
    if (times.size() < 2 || std::abs(median(times)) * unit < kExact * 1e9) return;
    if (!isSinglePrecision(times)) return;
    throw std::runtime_error(
        "has absolute times in single precision: write them as doubles, or as dt since the stamp "
        "in the name of the file");
}

struct Columns
{
    int x, y, z, intensity, ring;
    TimeColumn time;
};

Columns columnsOf(const Table& table, const std::string& time_field)
{
    const Columns c{
        columnOf(table, {"x"}),
        columnOf(table, {"y"}),
        columnOf(table, {"z"}),
        columnOf(table, {"intensity", "reflectivity", "scalar_Intensity", "Intensity"}),
        columnOf(table, {"ring", "channel", "laser_id", "line"}),
        timeColumnOf(table, time_field)};
    if (c.x >= 0 && c.y >= 0 && c.z >= 0) return c;
    std::string found;
    for (const auto& name : table.columns) found += " " + name;
    throw std::runtime_error("lacks a column x, y or z; it has" + found);
}

/** 0 for what cannot be the number of a ring. */
std::uint16_t ringOf(double value)
{
    return value > 0 && value < kMostRings ? static_cast<std::uint16_t>(value) : 0;
}

/** A time of today [ns], or NaN. */
double plausible(double time)
{
    return std::abs(time) <= kLatest ? time : std::numeric_limits<double>::quiet_NaN();
}

/** Of times whose meaning is known. */
Scan scanByTimes(const RawCloud& cloud)
{
    std::vector<double> finite;
    for (const double t : cloud.times)
        if (std::isfinite(plausible(t * cloud.unit))) finite.push_back(t);
    if (finite.empty()) throw std::runtime_error("has no time of a point that can be one");
    if (cloud.kind == RawCloud::Times::Absolute) checkPrecision(finite, cloud.unit);
    const double usual = median(finite);
    const auto is_near = [&](double t) { return std::abs(t - usual) * cloud.unit <= kFar; };
    double first = usual;
    for (const double t : finite)
        if (is_near(t)) first = std::min(first, t);
    const auto timeOf = [&](double t)
    {
        const auto ns = static_cast<Time>(std::llround(t * cloud.unit));
        return cloud.kind == RawCloud::Times::SinceStamp ? *cloud.stamp + ns : ns;
    };
    ScanBuilder builder(timeOf(first), cloud.points.size());
    std::size_t bad = 0;
    for (std::size_t i = 0; i < cloud.points.size(); i++)
    {
        const LidarPoint& p = cloud.points[i];
        if (is_near(cloud.times[i]))
            builder.add(p.position, p.intensity, timeOf(cloud.times[i]), p.ring);
        else if (p.position.allFinite())  // rows of NaN may be without a time as well
            bad++;
    }
    if (static_cast<double>(bad) > kWorstBadShare * static_cast<double>(cloud.points.size()))
        throw std::runtime_error(
            std::to_string(bad) + " of its points have a time far from that of the others");
    return builder.finish();
}

Scan scanWithoutTimes(const RawCloud& cloud)
{
    ScanBuilder builder(*cloud.stamp, cloud.points.size());
    for (const LidarPoint& p : cloud.points)
        builder.add(p.position, p.intensity, *cloud.stamp, p.ring);
    return builder.finish();
}
}  // namespace

CloudReader::CloudReader(
    const std::vector<std::filesystem::path>& files, NameStamps names, const ImportOptions& options,
    WarningSink warn)
    : names_(std::move(names)),
      time_field_(options.time_field),
      clock_(options.scan_stamp, std::move(warn))
{
    learn(files);
}

RawCloud CloudReader::readRaw(const std::filesystem::path& file) const
{
    const Table table = openTable(file);
    const Columns columns = columnsOf(table, time_field_);
    RawCloud cloud;
    cloud.kind = columns.time.kind;
    cloud.unit = columns.time.unit;
    cloud.stamp = names_.of(file);
    if (!cloud.stamp &&
        (cloud.kind == RawCloud::Times::None || cloud.kind == RawCloud::Times::SinceStamp))
        throw std::runtime_error(
            "has no absolute times of its points (column t or t_ns), and its name is no stamp "
            "(nanoseconds, microseconds or milliseconds, or seconds with decimals)");
    const bool timed = columns.time.column >= 0;
    if (timed) cloud.time_field = table.columns[static_cast<std::size_t>(columns.time.column)];
    std::vector<double> row;
    while (table.next(row))
    {
        LidarPoint point;
        point.position =
            Eigen::Vector3d(row[columns.x], row[columns.y], row[columns.z]).cast<float>();
        if (columns.intensity >= 0 && std::isfinite(row[columns.intensity]))
            point.intensity = static_cast<float>(row[columns.intensity]);
        if (columns.ring >= 0) point.ring = ringOf(row[columns.ring]);
        cloud.points.push_back(point);
        if (timed) cloud.times.push_back(row[columns.time.column]);
    }
    return cloud;
}

/** What SweepClock judges. */
bag::RawSweep CloudReader::toSweep(const RawCloud& cloud) const
{
    bag::RawSweep sweep;
    sweep.header = cloud.stamp.value_or(0);
    sweep.time_field = cloud.time_field;
    sweep.nominal_unit = unitOfName(cloud.time_field);
    sweep.single_precision = isSinglePrecision(cloud.times);
    for (std::size_t i = 0; i < cloud.points.size(); i++)
    {
        const LidarPoint& point = cloud.points[i];
        if (point.position.isZero(0) || !point.position.allFinite()) continue;
        if (!std::isfinite(cloud.times[i]))
        {
            sweep.bad_times++;
            continue;
        }
        sweep.points.push_back(point);
        sweep.times.push_back(cloud.times[i]);
        if (point.ring > 0) sweep.rings = std::max(sweep.rings, point.ring + 1);
    }
    return sweep;
}

void CloudReader::learn(const std::vector<std::filesystem::path>& files)
{
    std::vector<bag::RawSweep> sweeps;
    IntensityRange range;
    for (std::size_t i = 0; i < std::min(files.size(), kCloudsToJudge); i++)
    {
        try
        {
            const RawCloud cloud = readRaw(files[i]);
            for (const LidarPoint& point : cloud.points) range.add(point.intensity);
            if (cloud.kind == RawCloud::Times::Judged) sweeps.push_back(toSweep(cloud));
        }
        catch (const bag::FieldError&)
        {
            throw;
        }
        catch (const std::runtime_error&)  // told when it is its turn
        {
        }
    }
    intensity_scale_ = range.scale();
    std::vector<const bag::RawSweep*> judged;
    for (const bag::RawSweep& sweep : sweeps) judged.push_back(&sweep);
    if (!judged.empty()) clock_.learn(judged);
}

std::vector<std::string> CloudReader::findings() const
{
    auto lines = clock_.findings();
    if (!names_.finding().empty()) lines.push_back(names_.finding());
    if (intensity_scale_ != 1) lines.emplace_back(kIntensityScaled);
    return lines;
}

Scan CloudReader::toScan(const RawCloud& cloud)
{
    if (cloud.kind == RawCloud::Times::None) return scanWithoutTimes(cloud);
    if (cloud.kind != RawCloud::Times::Judged) return scanByTimes(cloud);
    if (!cloud.stamp && !clock_.knowsTimesWithoutStamps())
        throw std::runtime_error(
            "has times (" + cloud.time_field +
            ") that count from its stamp, but its name is no stamp (nanoseconds, microseconds or "
            "milliseconds, or seconds with decimals)");
    return clock_.toScan(toSweep(cloud));
}

Scan CloudReader::read(const std::filesystem::path& file)
{
    try
    {
        RawCloud cloud = readRaw(file);
        if (intensity_scale_ != 1)
            for (LidarPoint& point : cloud.points)
                point.intensity *= static_cast<float>(intensity_scale_);
        Scan scan = cloud.points.empty() ? Scan() : toScan(cloud);
        if (scan.points.empty()) throw std::runtime_error("has no valid point");
        return scan;
    }
    catch (const std::runtime_error& e)
    {
        const std::string cause = e.what(), name = "'" + file.string() + "'";
        if (cause.find(file.string()) != std::string::npos) throw;
        throw std::runtime_error(name + " " + cause);
    }
}

bool isCloud(const std::filesystem::path& file)
{
    const std::string ending = endingOf(file);
    return ending == ".csv" || ending == ".ply" || ending == ".pcd";
}

Scan readCloud(const std::filesystem::path& file)
{
    return CloudReader({file}, NameStamps({file}), {}, {}).read(file);
}
}  // namespace taut
