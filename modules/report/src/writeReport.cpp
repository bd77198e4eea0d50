#include "taut/report/writeReport.h"

#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "Page.h"
#include "PageData.h"

namespace taut
{
namespace
{
constexpr std::string_view kTitleMarker = "taut:title";
constexpr std::string_view kDataMarker = "<!-- taut:data -->";
constexpr std::size_t kBytesOfPoint = 7;
constexpr std::size_t kTags = 1000;  // [bytes] around the data, and what its length may vary by

std::string wholePage()
{
    std::string page;
    for (const std::string_view part : pageParts()) page += part;
    return page;
}

/** A piece of the page that begins at a marker's end. */
std::size_t find(const std::string& page, std::string_view marker)
{
    const std::size_t at = page.find(marker);
    if (at == std::string::npos) throw std::logic_error("the page has no place for its data");
    return at;
}

void writeBlock(std::ostream& out, const char* type, const char* id, const std::string& text)
{
    out << "<script type=\"" << type << "\" id=\"" << id << "\">" << text << "</script>\n";
}

void writeData(std::ostream& out, const PageData& data, const PackedPoints& points)
{
    constexpr const char* kBase64 = "text/plain";
    writeBlock(out, "application/json", "report-data", data.json);
    writeBlock(out, kBase64, "report-numbers", base64(data.numbers));
    writeBlock(out, kBase64, "report-positions", base64(points.positions));
    writeBlock(out, kBase64, "report-intensities", base64(points.intensities));
}

/** Points that fit beside all the rest. */
std::size_t roomForPoints(const Report& report, std::size_t page_size, std::size_t max_bytes)
{
    PackedPoints none;
    const PageData data = pageData(report, none);
    const std::size_t rest = page_size + data.json.size() + base64Size(data.numbers.size()) + kTags;
    if (rest > max_bytes)
        throw std::runtime_error(
            "the page takes " + std::to_string(rest) + " bytes without any points: more than " +
            std::to_string(max_bytes));
    return (max_bytes - rest) / 4 * 3 / kBytesOfPoint;
}
}  // namespace

void writeReport(const Report& report, const std::string& path, std::size_t max_bytes)
{
    const std::string page = wholePage();
    const std::string title = escaped(report.title);
    const PackedPoints points =
        pack(report.points, roomForPoints(report, page.size() + title.size(), max_bytes));
    const PageData data = pageData(report, points);
    const std::size_t at_title = find(page, kTitleMarker), at_data = find(page, kDataMarker);

    const std::string part = path + ".part";
    std::ofstream out(part, std::ios::binary);
    out << page.substr(0, at_title) << title
        << page.substr(at_title + kTitleMarker.size(), at_data - at_title - kTitleMarker.size());
    writeData(out, data, points);
    out << page.substr(at_data + kDataMarker.size());
    out.close();
    if (out && std::rename(part.c_str(), path.c_str()) == 0) return;
    std::remove(part.c_str());
    throw std::runtime_error("cannot write '" + path + "'");
}
}  // namespace taut
