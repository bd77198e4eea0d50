/** Recordings with something wrong: taut-slam neither crashes nor hangs, names the cause, ends with
 * the exit code of the rule, and loses no more than it must. */
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "../acceptance/slam_program.h"
#include "faults.h"
#include "taut/core/format.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/rawlog/RawlogWriter.h"
#include "temporary_folder.h"

namespace taut::test
{
void PrintTo(const Fault& fault, std::ostream* out)
{
    *out << fault.name;
}

namespace
{
Items sample()
{
    Items items;
    RawlogConfig config;
    config.path = kSample;
    RawlogSource source(config);
    while (auto item = source.next()) items.push_back(std::move(*item));
    return items;
}

void write(const std::string& path, const Items& items)
{
    RawlogWriter writer(path);
    for (const Measurement& item : items)
        std::visit([&writer](const auto& i) { writer.write(i); }, item);
    writer.close();
}

using ARecordingWith = testing::TestWithParam<Fault>;

TEST_P(ARecordingWith, IsMadeTheMostOf)
{
    const Fault& fault = GetParam();
    const TemporaryFolder folder;
    const std::string log = folder / "log.rawlog", out = folder / "out";
    Items items = sample();
    fault.spoil(items);
    write(log, items);
    const auto begin = std::chrono::steady_clock::now();
    const ProgramRun run = slam(log, out, fault.arguments);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    EXPECT_EQ(run.exit_code, fault.exit_code) << run.output;
    EXPECT_THAT(run.output, testing::HasSubstr(fault.says));
    const auto metrics = nlohmann::json::parse(contentOf(out + "/metrics.json"));
    EXPECT_GE(metrics["result"]["poses"], fault.poses);
    if (fault.error == 0) return;
    const double error = positionError(kSampleTruth, out + "/trajectory.tum");
    RecordProperty("error_mm", std::to_string(1000 * error));
    EXPECT_LT(error, fault.error) << run.output;
}

/** What the cases expect, in Markdown: docs/faults.md holds it. */
std::string table()
{
    std::string text =
        "| what goes wrong | exit code | said | position error, at most |\n|---|---|---|---|\n";
    for (const Fault& f : recordedFaults())
    {
        const std::string arguments = f.arguments.empty() ? "" : " (`" + f.arguments + "`)";
        text += "| " + f.what + arguments + " | " + std::to_string(f.exit_code) + " | " +
                (f.says.empty() ? "" : "`" + f.says + "`") + " | " +
                (f.error > 0 ? format("%g mm", 1000 * f.error) : "") + " |\n";
    }
    return text;
}

TEST(TheTableOfFaults, IsThatOfTheDocumentation)
{
    EXPECT_NE(contentOf(TAUT_DOCS "/faults.md").find(table()), std::string::npos)
        << "docs/faults.md has to hold:\n"
        << table();
}

INSTANTIATE_TEST_SUITE_P(
    Fault, ARecordingWith, testing::ValuesIn(recordedFaults()),
    [](const auto& test) { return test.param.name; });
}  // namespace
}  // namespace taut::test
