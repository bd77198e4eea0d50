#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "Browser.h"
#include "page_file.h"
#include "taut/report/writeReport.h"
#include "temporary_folder.h"

using namespace taut;
using namespace taut::test;

namespace
{
class APage : public ::testing::Test
{
 protected:
    void SetUp() override
    {
        if (!Browser::isThere())
            GTEST_SKIP() << "chromium is absent (Debian: chromium): the page is not looked at";
        browser = std::make_unique<Browser>(folder / "profile");
        browser->resize(1400, 900);
    }

    void TearDown() override
    {
        if (!browser) return;
        for (const std::string& complaint : browser->complaints()) ADD_FAILURE() << complaint;
    }

    double open(const Report& report)
    {
        writeReport(report, folder / "report.html");
        return browser->open(folder / "report.html");
    }

    double number(const std::string& expression)
    {
        return browser->evaluate(expression).get<double>();
    }

    /** Share of the pixels of the 3D view that are not of its ground. */
    double drawn()
    {
        return number(R"js((() => {
            const view = tautReport.view;
            view.drawAll();
            const gl = view.renderer.getContext();
            const w = gl.drawingBufferWidth, h = gl.drawingBufferHeight;
            const pixels = new Uint8Array(4 * w * h);
            gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
            let other = 0;
            for (let i = 0; i < pixels.length; i += 4)
              if (pixels[i] !== pixels[0] || pixels[i + 1] !== pixels[1]) other++;
            return other / (w * h);
        })())js");
    }

    /** Share of a plot's pixels that hold anything. */
    double drawnInPlot()
    {
        return number(R"js((() => {
            const canvas = tautReport.plots.all[0].back;
            const p = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
            let full = 0;
            for (let i = 3; i < p.length; i += 4) if (p[i] > 0) full++;
            return full / (p.length / 4);
        })())js");
    }

    void clickOn(const std::string& selector, double share = 0.5)
    {
        const auto box = browser->evaluate(
            "(() => { const r = document.querySelector('" + selector +
            "').getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; })()");
        browser->click(
            box[0].get<double>() + share * box[2].get<double>(),
            box[1].get<double>() + 0.5 * box[3].get<double>());
    }

    TemporaryFolder folder;
    std::unique_ptr<Browser> browser;
};
}  // namespace

TEST_F(APage, DrawsInEverySizeAndTheme)
{
    for (const auto& [width, height] : {std::pair(1400, 900), std::pair(400, 800)})
        for (const bool dark : {false, true})
        {
            browser->resize(width, height);
            browser->setDark(dark);
            open(roomReport(100'000));
            EXPECT_GT(drawn(), 0.1) << width << (dark ? " dark" : " light");
            EXPECT_GT(drawnInPlot(), 0.01) << width << (dark ? " dark" : " light");
            EXPECT_LE(number("document.documentElement.scrollWidth"), width);
        }
}

TEST_F(APage, MovesTheBodyWithItsSlider)
{
    open(roomReport(1000));
    const std::string x = "tautReport.view.body.position.x + tautReport.data.origin[0]";
    EXPECT_NEAR(number(x), 5, 0.01);
    clickOn("#time");
    EXPECT_NEAR(number("tautReport.timeline.t"), 10, 0.2);
    EXPECT_NEAR(number(x), 5 + 15 * std::sin(0.1 * number("tautReport.timeline.t")), 0.01);
    EXPECT_NEAR(
        number("tautReport.view.body.rotation.z"), 0.1 * number("tautReport.timeline.t"), 0.01);
}

TEST_F(APage, PlaysToItsEnd)
{
    open(roomReport(1000));
    browser->evaluate("document.getElementById('speed').value = '64'");
    clickOn("#play");
    browser->evaluate(
        "new Promise(done => tautReport.timeline.listen(t => { if (t >= 20) done(); }))");
    EXPECT_NEAR(number("tautReport.timeline.t"), 20, 1e-4);
    EXPECT_FALSE(browser->evaluate("tautReport.timeline.playing").get<bool>());
}

TEST_F(APage, JumpsFromItsListsAndPlots)
{
    open(roomReport(1000));
    clickOn("#warnings button");
    EXPECT_NEAR(number("tautReport.timeline.t"), 12, 1e-3);
    clickOn("#stretches button");
    EXPECT_NEAR(number("tautReport.timeline.t"), 5, 1e-3);
    clickOn("#loops button");
    EXPECT_NEAR(number("tautReport.timeline.t"), 15, 1e-3);
    EXPECT_NEAR(number("tautReport.view.controls.target.x + tautReport.data.origin[0]"), 18, 0.01);
    browser->evaluate("document.querySelector('.plot-area').scrollIntoView({block: 'center'})");
    clickOn(".plot-area", 0.9);
    EXPECT_GT(number("tautReport.timeline.t"), 16);
}

TEST_F(APage, OpensAMillionPointsWithinThreeSeconds)
{
    double least = open(roomReport(1'000'000));
    EXPECT_EQ(number("tautReport.data.points.count"), 1'000'000);
    for (int again = 0; again < 2; again++)  // the machine may be busy with other things
        least = std::min(least, browser->open(folder / "report.html"));
    RecordProperty("milliseconds", static_cast<int>(least));
    EXPECT_LT(least, 3000);
    browser->evaluate("new Promise(done => setTimeout(done, 2000))");
    EXPECT_GT(number("tautReport.view.drawn"), 50'000);  // more where the machine is fast
    EXPECT_GT(drawn(), 0.1);
}

TEST_F(APage, RunsNothingThatARecordingSays)
{
    const std::string evil =
        "</script><script>window.evil = 1</script><img src=x onerror='evil=1'>";
    Report report = roomReport(1000);
    report.title = report.warnings[0].kind = report.warnings[0].first[0].text = evil;
    report.texts = {{evil, evil}};
    report.plots[0].title = report.plots[0].curves[0].name = evil;
    report.loops[0].reason = evil;
    open(report);
    EXPECT_TRUE(browser->evaluate("window.evil === undefined").get<bool>());
    EXPECT_EQ(number("document.querySelectorAll('img').length"), 0);
    EXPECT_EQ(browser->evaluate("document.title"), evil);
    EXPECT_EQ(browser->evaluate("document.getElementById('title').textContent"), evil);
}

TEST_F(APage, OfARunWithoutPosesOpens)
{
    Report report;
    report.title = "nothing.rawlog";
    report.warnings = {{"no_rest", 1, {{0, "no_rest", "it never rests"}}}};
    open(report);
    EXPECT_EQ(browser->evaluate("document.getElementById('title').textContent"), report.title);
    for (const char* id : {"timeline", "show-loops-label", "show-truth-label"})
        EXPECT_EQ(
            browser->evaluate(
                "getComputedStyle(document.getElementById('" + std::string(id) + "')).display"),
            "none")
            << id;
}
