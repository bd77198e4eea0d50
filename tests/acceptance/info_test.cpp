/** taut-info as a user runs it. */
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "data_folder.h"
#include "program.h"
#include "temporary_folder.h"

namespace
{
using namespace taut::test;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kSample = TAUT_RAWLOGS "/hall_fast.rawlog";

ProgramRun info(const std::string& arguments)
{
    return runProgram(TAUT_INFO, arguments);
}

/** What the program says of a log, for programs. */
struct Doctor
{
    explicit Doctor(const std::string& log, const std::string& more = "")
    {
        const ProgramRun run = info(log + " --json -q " + more);
        exit_code = run.exit_code;
        json = nlohmann::json::parse(run.output, nullptr, false);
        EXPECT_FALSE(json.is_discarded()) << run.output;
        for (const auto& f : json["findings"]) kinds.insert(f["kind"].get<std::string>());
    }

    nlohmann::json finding(const std::string& kind) const
    {
        for (const auto& f : json["findings"])
            if (f["kind"] == kind) return f;
        return nullptr;
    }

    double clockOffset() const
    {
        const auto& offset = json["rotation"]["clock_offset"];
        return offset.is_null() ? std::nan("") : offset["value_s"].get<double>();
    }

    int exit_code = -1;
    nlohmann::json json;
    std::set<std::string> kinds;
};

TEST(TautInfo, ExplainsEveryOption)
{
    const ProgramRun run = info("--help");
    EXPECT_EQ(run.exit_code, 0);
    for (const char* option :
         {"LOG.rawlog", "-r", "--rig", "--lidar", "--imu", "--from-time", "--to-time", "--window",
          "--no-matching", "--threads", "--json", "-q", "--quiet", "--version", "Exit codes"})
        EXPECT_THAT(run.output, HasSubstr(option));
}

TEST(TautInfo, GivesTwoForBadUsage)
{
    for (const char* wrong :
         {"", "--no-such-option", "--window 1", "--threads -1", "--from-time 5 --to-time 4"})
        EXPECT_EQ(info((*wrong ? kSample + " " : "") + wrong).exit_code, 2) << wrong;
}

TEST(TautInfo, FindsOnlyTheShortRestOfTheSample)
{
    const Doctor sample(kSample);
    EXPECT_EQ(sample.exit_code, 3);
    EXPECT_THAT(sample.kinds, ElementsAre("short_rest"));
    EXPECT_NEAR(sample.finding("short_rest")["value"], 3, 0.5);
    EXPECT_NEAR(sample.clockOffset(), 0, 5e-4);
    EXPECT_LT(sample.json["rotation"]["extrinsic_rotation"]["angle_deg"], 0.3);
    EXPECT_THAT(info(kSample + " --no-matching -q").output, HasSubstr("[short_rest]"));
}

TEST(TautInfo, SaysTheSameWithAnyNumberOfThreads)
{
    EXPECT_EQ(
        info(kSample + " -q --window 5 --threads 1").output,
        info(kSample + " -q --window 5 --threads 3").output);
}

TEST(TautInfo, GivesOneAndOneLineWhereNothingCanBeRead)
{
    const TemporaryFolder folder;
    const std::string empty = folder / "empty.rawlog", text = folder / "text.rawlog";
    std::ofstream{empty};
    std::ofstream{text} << "This is a letter to a friend of mine, and not a rawlog.";
    for (const std::string& log : {folder / "absent.rawlog", empty, text, folder / "."})
    {
        const ProgramRun run = info(log);
        EXPECT_EQ(run.exit_code, 1) << log;
        EXPECT_THAT(run.output, HasSubstr(log));
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    }
    const std::string stub = folder / "stub.rawlog";
    std::filesystem::copy_file(kSample, stub);
    std::filesystem::resize_file(stub, 40);
    const ProgramRun run = info(stub);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
}

TEST(TautInfo, JudgesATruncatedLogUpToItsDamage)
{
    const TemporaryFolder folder;
    const std::string log = folder / "log.rawlog";
    std::filesystem::copy_file(kSample, log);
    for (const double share : {0.9, 0.4, 0.05})
    {
        std::filesystem::resize_file(
            log, static_cast<std::uintmax_t>(
                     share * static_cast<double>(std::filesystem::file_size(kSample))));
        const Doctor cut(log);
        EXPECT_EQ(cut.exit_code, 3);
        EXPECT_THAT(cut.kinds, Contains("rawlog_truncated"));
        EXPECT_EQ(cut.json["log"]["incomplete"], true);
        EXPECT_NEAR(cut.json["lidar"]["scans"].get<double>() / 124, share, 0.1);
    }
}

#ifdef TAUT_SIMULATE
TEST(TautInfo, FindsAllFaultsOfTheScenarioWithFaults)
{
    const TemporaryFolder folder;
    const std::string log = folder / "log.rawlog";
    ASSERT_EQ(
        runProgram(
            TAUT_SIMULATE, "-q -c " TAUT_CONFIG "/scenarios/hall_walk_faults.yaml -o " + log +
                               " --set lidar.dropout=0.6")
            .exit_code,
        0);
    const Doctor doctor(log);
    EXPECT_EQ(doctor.exit_code, 3);
    // "gravity": the accelerometer of that preset has a bias of 0.35 m/s^2.
    EXPECT_THAT(
        doctor.kinds, ElementsAre(
                          "clock_offset", "gravity", "imu_duplicate", "imu_gap", "lidar_gap",
                          "nan_points", "scan_duplicate"));
    EXPECT_NEAR(doctor.clockOffset(), 0.004, 5e-4);
    EXPECT_EQ(doctor.finding("imu_gap")["count"], 2);  // and the clock that jumps
    EXPECT_NEAR(doctor.finding("nan_points")["value"], 3, 0.1);
    EXPECT_NEAR(doctor.finding("lidar_gap")["value"], 2.6, 0.11);
}
#endif

/** The recordings that may not be copied here (TAUT_DATA); their README says what is true. */
std::string recording(const std::string& name)
{
    const auto path = dataFolder() / (name + ".rawlog");
    return std::filesystem::exists(path) ? path.string() : "";
}

TEST(TautInfo, RaisesNoFalseAlarmOnGoodRecordings)
{
    std::string absent;
    for (const char* name : {"hall_violent", "handheld_real_imu"})
    {
        const std::string log = recording(name);
        if (log.empty())
        {
            absent += " " + std::string(name) + ".rawlog";
            continue;
        }
        const Doctor doctor(log);
        EXPECT_EQ(doctor.exit_code, 0) << name;
        EXPECT_THAT(doctor.kinds, IsEmpty()) << name;
        EXPECT_NEAR(doctor.clockOffset(), 0, 5e-4) << name;
        EXPECT_LT(doctor.json["rotation"]["extrinsic_rotation"]["angle_deg"], 0.5) << name;
    }
    if (!absent.empty()) return skipWithout(absent.substr(1));
}

TEST(TautInfo, FindsTheHolesOfTheTripod)
{
    const std::string log = recording("tripod_vlp16_imu");
    if (log.empty()) return skipWithout("tripod_vlp16_imu.rawlog");
    const Doctor doctor(log);
    EXPECT_EQ(doctor.exit_code, 3);
    EXPECT_THAT(doctor.kinds, Contains("imu_gap"));
    EXPECT_NEAR(doctor.finding("imu_gap")["value"], 0.15, 0.01);
    EXPECT_GE(doctor.finding("imu_gap")["count"], 95);
    EXPECT_NEAR(doctor.finding("lidar_holes")["value"], 0.15, 0.01);
    // 0.034 rad/s about one axis: neither clock nor the 2 degrees of the mounting can be seen.
    EXPECT_THAT(doctor.json["rotation"]["not_estimated"], HasSubstr("hardly turns"));
    EXPECT_THAT(doctor.kinds, Not(Contains("extrinsic_rotation")));
}

TEST(TautInfo, MissesTheImuOfTheCar)
{
    const std::string log = recording("street_hdl64");
    if (log.empty()) return skipWithout("street_hdl64.rawlog");
    const Doctor doctor(log);
    EXPECT_EQ(doctor.exit_code, 3);
    EXPECT_THAT(doctor.kinds, ElementsAre("no_imu"));
    EXPECT_EQ(doctor.json["lidar"]["scans"], 20);
    EXPECT_TRUE(doctor.json["rotation"].is_null());
}
}  // namespace
