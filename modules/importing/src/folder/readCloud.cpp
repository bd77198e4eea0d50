#include "readCloud.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "CsvReader.h"
#include "taut/core/TimeText.h"
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
    bool relative = false;
};

TimeColumn timeColumnOf(const Table& table)
{
    TimeColumn found;
    for (const TimeColumn& candidate :
         {TimeColumn{columnOf(table, {"t"}), 1e9, false},
          TimeColumn{columnOf(table, {"t_ns"}), 1, false},
          TimeColumn{columnOf(table, {"dt"}), 1e9, true},
          TimeColumn{columnOf(table, {"dt_ns"}), 1, true}})
    {
        if (candidate.column < 0) continue;
        if (found.column >= 0)
            throw std::runtime_error("has more than one column of times: t, t_ns, dt or dt_ns");
        found = candidate;
    }
    return found;
}

/** Times of today as 32-bit floats are the same for a minute and more. */
void checkPrecision(const std::vector<double>& times, double unit)
{
    constexpr double kExact = 1e5;  // [s] up to which a float tells 10 ms
    if (times.size() < 2 || std::abs(times.front()) * unit < kExact * 1e9) return;
    for (const double t : times)
        if (static_cast<double>(static_cast<float>(t)) != t) return;
    throw std::runtime_error(
        "has absolute times in single precision: write them as doubles, or as dt since the stamp "
        "in the name of the file");
}

struct Columns
{
    int x, y, z, intensity, ring;
    TimeColumn time;
};

Columns columnsOf(const Table& table)
{
    const Columns c{
        columnOf(table, {"x"}),
        columnOf(table, {"y"}),
        columnOf(table, {"z"}),
        columnOf(table, {"intensity", "reflectivity"}),
        columnOf(table, {"ring", "channel", "laser_id", "line"}),
        timeColumnOf(table)};
    if (c.x >= 0 && c.y >= 0 && c.z >= 0) return c;
    std::string found;
    for (const auto& name : table.columns) found += " " + name;
    throw std::runtime_error("lacks a column x, y or z; it has" + found);
}

/** 0 for what cannot be the number of a ring. */
int ringOf(double value)
{
    return value > 0 && value < kMostRings ? static_cast<int>(value) : 0;
}

/** `times`: in the file's unit, one a point; empty if it has none. */
Scan build(
    const Columns& columns, const std::vector<std::vector<double>>& rows,
    const std::vector<double>& times, std::optional<Time> name_stamp)
{
    const auto timeOf = [&](std::size_t i)
    {
        if (times.empty()) return *name_stamp;
        const auto t = static_cast<Time>(std::llround(times[i] * columns.time.unit));
        return columns.time.relative ? *name_stamp + t : t;
    };
    std::size_t first = 0;
    for (std::size_t i = 1; i < times.size(); i++)
        if (times[i] < times[first]) first = i;
    ScanBuilder builder(timeOf(first), rows.size());
    for (std::size_t i = 0; i < rows.size(); i++)
    {
        const auto& row = rows[i];
        const Eigen::Vector3d position(row[columns.x], row[columns.y], row[columns.z]);
        builder.add(
            position.cast<float>(),
            columns.intensity < 0 ? 0.0f : static_cast<float>(row[columns.intensity]), timeOf(i),
            columns.ring < 0 ? 0 : ringOf(row[columns.ring]));
    }
    const std::size_t bad = builder.notFinite() + builder.badTime();
    if (static_cast<double>(bad) > kWorstBadShare * static_cast<double>(builder.seen()))
        throw std::runtime_error(
            std::to_string(bad) + " of its points are not finite or 2 s or more from the first");
    Scan scan = builder.finish();
    if (scan.points.empty()) throw std::runtime_error("has no valid point");
    return scan;
}

Scan read(const std::filesystem::path& file)
{
    const Table table = openTable(file);
    const Columns columns = columnsOf(table);
    const auto name_stamp = stampOfName(file);
    if (!name_stamp && (columns.time.column < 0 || columns.time.relative))
        throw std::runtime_error(
            "has no absolute times of its points (column t or t_ns), and its name is no stamp "
            "(nanoseconds, or seconds with decimals)");
    std::vector<std::vector<double>> rows;
    std::vector<double> times, row;
    while (table.next(row))
    {
        rows.push_back(row);
        if (columns.time.column < 0) continue;
        times.push_back(row[columns.time.column]);
        if (!std::isfinite(times.back()) || std::abs(times.back() * columns.time.unit) > kLatest)
            throw std::runtime_error("has a time that is none");
    }
    if (!columns.time.relative) checkPrecision(times, columns.time.unit);
    return build(columns, rows, times, name_stamp);
}
}  // namespace

std::optional<Time> stampOfName(const std::filesystem::path& file)
{
    const std::string name = file.stem().string();
    try
    {
        std::optional<Time> stamp;
        if (name.find('.') != std::string::npos)
            stamp = parseSeconds(name);
        else if (name.size() >= 16)
            stamp = parseSeconds(name + "e-9");
        if (stamp && std::abs(static_cast<double>(*stamp)) <= kLatest) return stamp;
    }
    catch (const std::invalid_argument&)
    {
    }
    return {};
}

bool isCloud(const std::filesystem::path& file)
{
    const std::string ending = endingOf(file);
    return ending == ".csv" || ending == ".ply" || ending == ".pcd";
}

Scan readCloud(const std::filesystem::path& file)
{
    try
    {
        return read(file);
    }
    catch (const std::runtime_error& e)
    {
        const std::string cause = e.what(), name = "'" + file.string() + "'";
        if (cause.find(file.string()) != std::string::npos) throw;
        throw std::runtime_error(name + " " + cause);
    }
}
}  // namespace taut
