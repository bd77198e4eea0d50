#include "taut/report/writeReport.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "page_file.h"
#include "temporary_folder.h"

using namespace taut;
using namespace taut::test;

namespace fs = std::filesystem;

namespace
{
class AReport : public ::testing::Test
{
 protected:
    std::string written(const Report& report, std::size_t max_bytes = kLargestReport) const
    {
        writeReport(report, path, max_bytes);
        return contentOf(path);
    }

    TemporaryFolder folder;
    std::string path = folder / "report.html";
};

const std::string kEvil =
    "</script><script>alert(1)</script><!-- <img src=x onerror=alert(2)> &amp; \"'";
}  // namespace

TEST_F(AReport, KeepsItsBoundWithManyPoints)
{
    const std::string page = written(roomReport(3'000'000));
    EXPECT_LE(page.size(), kLargestReport);
    EXPECT_GT(page.size(), kLargestReport - 2000);  // and uses it
    const auto data = dataOf(page);
    EXPECT_EQ(data["points"]["of"], 3'000'000);
    const auto count = data["points"]["count"].get<std::size_t>();
    EXPECT_GT(count, 1'400'000u);
    EXPECT_EQ(decoded<std::uint16_t>(blockOf(page, "report-positions")).size(), 3 * count);
    EXPECT_EQ(decoded<std::uint8_t>(blockOf(page, "report-intensities")).size(), count);
}

TEST_F(AReport, KeepsItsBoundWithLongTexts)
{
    Report report = roomReport(1'000'000);
    report.texts = {{"config.yaml", std::string(5'000'000, '<')}};
    report.warnings[0].first[0].text = std::string(5'000'000, 'x');
    report.loops.resize(100'000, report.loops.front());
    report.stretches.resize(100'000, report.stretches.front());
    const std::string page = written(report);
    EXPECT_LE(page.size(), kLargestReport);
    EXPECT_EQ(dataOf(page)["loops"]["of"], 100'000);
    EXPECT_LT(dataOf(page)["loops"]["list"].size(), 5'000u);
}

TEST_F(AReport, ThatCannotFitIsAnError)
{
    EXPECT_THROW(written(roomReport(10), 100'000), std::runtime_error);
    EXPECT_FALSE(fs::exists(path));
}

TEST_F(AReport, RoundsPointsToA65535thOfTheirBox)
{
    Report report;
    for (int i = 0; i < 1000; i++)
        report.points.push_back(
            {{-100 + 0.2f * static_cast<float>(i), 7, 1e-3f * static_cast<float>(i)}, 0});
    const std::string page = written(report);
    const auto data = dataOf(page);
    const auto quantised = decoded<std::uint16_t>(blockOf(page, "report-positions"));
    ASSERT_EQ(quantised.size(), 3000u);
    std::vector<bool> seen(1000);
    for (std::size_t k = 0; k < 1000; k++)
    {
        Vector3d p;
        for (std::size_t axis = 0; axis < 3; axis++)
            p[static_cast<int>(axis)] =
                data["origin"][axis].get<double>() +
                quantised[3 * k + axis] / 65535. * data["points"]["size"][axis].get<double>();
        const auto i = static_cast<std::size_t>(std::lround((p.x() + 100) / 0.2));
        ASSERT_LT(i, 1000u);
        seen[i] = true;
        const Vector3d error = p - report.points[i].position.cast<double>();
        EXPECT_LE(std::abs(error.x()), 0.5 * 199.8 / 65535 + 1e-5);
        EXPECT_LE(std::abs(error.y()), 1e-6);
        EXPECT_LE(std::abs(error.z()), 0.5 * 0.999 / 65535 + 1e-6);
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 1000);
    EXPECT_EQ(blockOf(page, "report-intensities"), "");  // there is none
}

TEST_F(AReport, BeginsWithAnEvenSampleOfItsPoints)
{
    Report report;
    for (int i = 0; i < 10'000; i++) report.points.push_back({{static_cast<float>(i), 0, 0}, 0});
    const auto quantised = decoded<std::uint16_t>(blockOf(written(report), "report-positions"));
    std::array<int, 10> tenths{};
    for (std::size_t k = 0; k < 1000; k++)
        tenths[std::min<std::size_t>(9, quantised[3 * k] * 10u / 65536u)]++;
    for (const int n : tenths) EXPECT_NEAR(n, 100, 5);
}

TEST_F(AReport, TellsTimesAndPlacesFromItsBegin)
{
    const std::string page = written(roomReport(1000));
    const auto data = dataOf(page);
    const auto numbers = decoded<float>(blockOf(page, "report-numbers"));
    const auto at = data["path"][0].get<std::size_t>();
    EXPECT_EQ(data["path"][1], 8 * 201);
    EXPECT_FLOAT_EQ(numbers[at + 8 * 200], 20);
    EXPECT_NEAR(
        numbers[at + 8 * 200 + 1] + data["origin"][0].get<double>(), 5 + 15 * std::sin(2.0), 1e-5);
    EXPECT_NEAR(data["warnings"][0]["first"][0]["t"].get<double>(), 12, 1e-9);
    EXPECT_NEAR(data["stretches"]["list"][0]["to"].get<double>(), 6, 1e-9);
}

TEST_F(AReport, EscapesEveryText)
{
    Report report = roomReport(10);
    report.title = report.subtitle = kEvil;
    report.headlines = {{kEvil, kEvil}};
    report.facts = {{kEvil, kEvil, {kEvil}, {{kEvil}}}};
    report.plots[0].title = report.plots[0].unit = report.plots[0].hint = kEvil;
    report.plots[0].curves[0].name = kEvil;
    report.loops[0].name = report.loops[0].verdict = report.loops[0].reason = kEvil;
    report.stretches[0].cause = kEvil;
    report.warnings = {{kEvil, 1, {{0, kEvil, kEvil}}}};
    report.texts = {{kEvil, kEvil}};
    report.accuracy = ReportAccuracy{kEvil, report.facts, report.plots, {}};
    const std::string page = written(report);
    EXPECT_EQ(page.find("<script>alert"), std::string::npos);
    EXPECT_EQ(page.find("<img src=x"), std::string::npos);
    EXPECT_EQ(page.find("<!-- <img"), std::string::npos);
    EXPECT_EQ(dataOf(page)["warnings"][0]["first"][0]["text"], kEvil);
    EXPECT_NE(page.find("<title>&lt;/script&gt;"), std::string::npos);
}

TEST_F(AReport, ReplacesBytesThatAreNotUtf8)
{
    Report report = roomReport(10);
    report.title = "caf\xe9.rawlog";
    report.warnings[0].first[0].text = "label \xff\xfe";
    const std::string page = written(report);
    EXPECT_NE(page.find("<title>caf\xef\xbf\xbd.rawlog</title>"), std::string::npos);
    EXPECT_EQ(dataOf(page)["warnings"][0]["first"][0]["text"], "label \xef\xbf\xbd\xef\xbf\xbd");
}

TEST_F(AReport, LeavesOutPointsThatAreNotFinite)
{
    Report report;
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    report.points = {{{0, 0, 0}, kNan}, {{kNan, 0, 0}, 1}, {{1, 2, 3}, 4}};
    const std::string page = written(report);
    EXPECT_EQ(dataOf(page)["points"]["count"], 2);
    const auto intensities = decoded<std::uint8_t>(blockOf(page, "report-intensities"));
    EXPECT_EQ(std::count(intensities.begin(), intensities.end(), 255), 1);
}

TEST_F(AReport, OfNothingIsAPage)
{
    const std::string page = written(Report{});
    EXPECT_EQ(dataOf(page)["points"]["count"], 0);
    EXPECT_EQ(page.find("taut:"), std::string::npos);
    EXPECT_EQ(page.substr(page.size() - 8), "</html>\n");
}

TEST_F(AReport, NeedsNothingFromElsewhere)
{
    const std::string page = written(roomReport(10));
    for (const char* word : {"<link", "src=\"http", "@import", "url(http", "<iframe"})
        EXPECT_EQ(page.find(word), std::string::npos) << word;
    EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

TEST_F(AReport, OfCurvesThatDoNotMatchTheirTimesIsRefused)
{
    Report report = roomReport(10);
    report.plots[0].curves[0].values.pop_back();
    EXPECT_THROW(written(report), std::invalid_argument);
}

TEST_F(AReport, AppearsWhenItIsComplete)
{
    written(roomReport(10));
    EXPECT_FALSE(fs::exists(path + ".part"));
    EXPECT_THROW(writeReport(Report{}, folder / "absent/report.html"), std::runtime_error);
    fs::create_directories(folder / "taken/report.html");
    EXPECT_THROW(writeReport(Report{}, folder / "taken/report.html"), std::runtime_error);
    EXPECT_FALSE(fs::exists(folder / "taken/report.html.part"));
}
