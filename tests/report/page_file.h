#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "taut/report/Report.h"

namespace taut::test
{
inline std::string contentOf(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/** The text of a script element of the page. */
inline std::string blockOf(const std::string& page, const std::string& id)
{
    const std::string tag = "id=\"" + id + "\">";
    const std::size_t at = page.find(tag);
    if (at == std::string::npos) return {};
    const std::size_t begin = at + tag.size();
    return page.substr(begin, page.find("</script>", begin) - begin);
}

inline nlohmann::json dataOf(const std::string& page)
{
    return nlohmann::json::parse(blockOf(page, "report-data"));
}

/** Numbers out of base64. */
template <class Number>
std::vector<Number> decoded(const std::string& text)
{
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0;
    int count = 0;
    for (const char c : text)
    {
        if (c == '=') break;
        bits = bits << 6 | static_cast<unsigned>(digits.find(c));
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 255);
    }
    std::vector<Number> numbers(bytes.size() / sizeof(Number));
    if (!numbers.empty())
        std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
    return numbers;
}

/** A room of 40 by 30 by 5 m with a body that walks through it on an arc, for 20 s. */
inline Report roomReport(std::size_t points)
{
    Report report;
    report.title = "room.rawlog";
    report.points.reserve(points);
    for (std::size_t i = 0; i < points; i++)
    {
        const double u = std::fmod(static_cast<double>(i) * 0.754877666, 1);
        const double v = std::fmod(static_cast<double>(i) * 0.569840291, 1);
        const std::array<Vector3d, 3> walls{
            Vector3d(40 * u, 30 * v, 0), Vector3d(40 * u, 30, 5 * v), Vector3d(40, 30 * u, 5 * v)};
        report.points.push_back({walls[i % 3].cast<float>(), static_cast<float>(100 * u)});
    }
    constexpr Time kBegin = 1'700'000'000'000'000'000;
    ReportPlot speed{"Speed", "m/s", "", false, {}, {{"speed", {}, {}}}};
    for (int i = 0; i <= 200; i++)
    {
        const double angle = 0.01 * i;
        const Time t = kBegin + i * Time{100'000'000};
        report.path.push_back(
            {t, {expSO3({0, 0, angle}), {5 + 15 * std::sin(angle), 20 - 15 * std::cos(angle), 1}}});
        speed.times.push_back(t);
        speed.curves[0].values.push_back(static_cast<float>(1.5 + 0.1 * std::sin(10 * angle)));
    }
    report.plots = {speed};
    report.stretches = {{kBegin + 5'000'000'000, kBegin + 6'000'000'000, "pose_doubtful", true}};
    report.warnings = {
        {"imu_gap", 7, {{kBegin + 12'000'000'000, "imu_gap", "no sample for 0.4 s"}}}};
    report.loops = {
        {"submaps 0 and 3",
         "accepted",
         "two agree",
         true,
         kBegin + 1'000'000'000,
         kBegin + 15'000'000'000,
         {6, 5, 1},
         {18, 12, 1},
         0.12}};
    return report;
}
}  // namespace taut::test
