#include "KittiFiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "../filesIn.h"
#include "taut/core/TimeText.h"
#include "taut/rawlog/ScanBuilder.h"

namespace taut::kitti
{
namespace fs = std::filesystem;

namespace
{
std::vector<std::string> linesOf(const fs::path& file)
{
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read '" + file.string() + "'");
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);)
    {
        while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0)
            line.pop_back();
        lines.push_back(line);
    }
    return lines;
}

constexpr Time kSecond = 1'000'000'000;
constexpr int kLastYear = 2200;                      // nanoseconds end in 2262
constexpr Time kLatest = 4'000'000'000'000'000'000;  // [ns]: differences do not overflow

bool within(Time value, Time least, Time most)
{
    return value >= least && value <= most;
}

Time parseDate(const std::string& text)
{
    std::tm date{};
    int read = 0;
    if (std::sscanf(
            text.c_str(), "%d-%d-%d %d:%d:%n", &date.tm_year, &date.tm_mon, &date.tm_mday,
            &date.tm_hour, &date.tm_min, &read) != 5 ||
        read == 0 || !within(date.tm_year, 1970, kLastYear) || !within(date.tm_mon, 1, 12) ||
        !within(date.tm_mday, 1, 31) || !within(date.tm_hour, 0, 23) || !within(date.tm_min, 0, 59))
        throw std::invalid_argument("'" + text + "' is no date and time");
    const Time seconds = parseSeconds(text.substr(static_cast<std::size_t>(read)));
    if (!within(seconds, 0, 61 * kSecond))  // a leap second is the 60th
        throw std::invalid_argument("'" + text + "' is no date and time");
    date.tm_year -= 1900;
    date.tm_mon -= 1;
    return static_cast<Time>(timegm(&date)) * kSecond + seconds;
}

std::vector<float> readFloats(const fs::path& file)
{
    if (file.extension() == ".txt")
    {
        std::ifstream in(file);
        std::vector<float> values{std::istream_iterator<float>(in), {}};
        if (!in.eof()) throw std::runtime_error("'" + file.string() + "' is no text of numbers");
        return values;
    }
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    const auto bytes = in ? static_cast<std::size_t>(in.tellg()) : 0;
    std::vector<float> values(bytes / sizeof(float));
    in.seekg(0);
    const auto whole = static_cast<std::streamsize>(values.size() * sizeof(float));
    if (bytes % sizeof(float) != 0 || !in.read(reinterpret_cast<char*>(values.data()), whole))
        throw std::runtime_error("'" + file.string() + "' is cut off");
    return values;
}
}  // namespace

std::vector<std::optional<Time>> readTimestamps(const fs::path& file)
{
    std::vector<std::optional<Time>> times;
    for (const std::string& line : linesOf(file)) try
        {
            times.push_back(line.empty() ? std::nullopt : std::make_optional(parseDate(line)));
        }
        catch (const std::invalid_argument& e)
        {
            throw std::runtime_error(
                file.string() + ":" + std::to_string(times.size() + 1) + ": " + e.what());
        }
    return times;
}

std::vector<Time> readTimes(const fs::path& file)
{
    std::vector<Time> times;
    for (const std::string& line : linesOf(file)) try
        {
            const Time t = parseSeconds(line);
            if (!within(t, -kLatest, kLatest))
                throw std::invalid_argument("time '" + line + "' is out of range");
            times.push_back(t);
        }
        catch (const std::invalid_argument& e)
        {
            throw std::runtime_error(
                file.string() + ":" + std::to_string(times.size() + 1) + ": " + e.what());
        }
    return times;
}

std::map<std::string, std::vector<double>> readCalibration(const fs::path& file)
{
    std::map<std::string, std::vector<double>> entries;
    for (const std::string& line : linesOf(file))
    {
        const auto colon = line.find(':');
        std::istringstream words(colon == std::string::npos ? line : line.substr(colon + 1));
        auto& values = entries[colon == std::string::npos ? "" : line.substr(0, colon)];
        for (double value = 0; words >> value;) values.push_back(value);
    }
    return entries;
}

std::optional<std::size_t> frameOf(const fs::path& file)
{
    const std::string name = file.stem().string();
    const bool digits =
        !name.empty() && name.size() < 12 &&
        std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!digits) return {};
    return std::stoul(name);
}

Scan readPoints(
    const fs::path& file, Time stamp, const std::function<Duration(double x, double y)>& offset_of)
{
    const std::vector<float> values = readFloats(file);
    if (values.size() % 4 != 0)
        throw std::runtime_error("'" + file.string() + "' does not hold four numbers a point");
    ScanBuilder builder(stamp, values.size() / 4);
    const auto is_direction = [&values](std::size_t i)
    { return std::isfinite(values[i]) && std::isfinite(values[i + 1]); };
    for (std::size_t i = 0; i < values.size(); i += 4)
        builder.add(
            {values[i], values[i + 1], values[i + 2]}, 255 * values[i + 3],
            is_direction(i) ? stamp + offset_of(values[i], values[i + 1]) : stamp, 0);
    Scan scan = builder.finish();
    if (scan.points.empty()) throw std::runtime_error("'" + file.string() + "' has no valid point");
    return scan;
}

double shareOfSweep(double x, double y)
{
    return (M_PI - std::atan2(y, x)) / (2 * M_PI);
}

OxtsReader::OxtsReader(const fs::path& folder, WarningSink warn)
    : folder_(folder),
      warn_(std::move(warn)),
      files_(filesIn(folder / "data")),
      times_(readTimestamps(folder / "timestamps.txt"))
{
}

std::optional<ImuSample> OxtsReader::next()
{
    constexpr std::size_t kAccel = 11, kGyro = 17, kFewest = 20;  // dataformat.txt, from 0
    while (next_ < files_.size())
    {
        const fs::path& file = files_[next_++];
        const auto frame = frameOf(file);
        std::ifstream in(file);
        const std::vector<double> values{std::istream_iterator<double>(in), {}};
        if (values.size() >= kFewest && frame && *frame < times_.size() && times_[*frame])
        {
            const auto vector = [&values](std::size_t at)
            { return Vector3d(values[at], values[at + 1], values[at + 2]); };
            return ImuSample{*times_[*frame], vector(kGyro), vector(kAccel)};
        }
        if (warn_)
            warn_(
                {0, "imu_invalid",
                 "'" + file.string() + "' has no time or too few numbers; left out"});
    }
    return {};
}
}  // namespace taut::kitti
