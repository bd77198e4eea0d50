/** Captures through the installed rawlog-grabber with taut's plug-in, against the facts of an
 * independent decoder, and taut-slam on what it wrote. */
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "data_folder.h"
#include "slam_program.h"
#include "taut/core/TimeText.h"
#include "taut/rawlog/RawlogSource.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;
using testing::HasSubstr;
namespace fs = std::filesystem;

class RawlogGrabber : public testing::Test
{
 protected:
    void SetUp() override
    {
        if (runProgram("command -v rawlog-grabber", "").exit_code != 0)
            GTEST_SKIP() << "rawlog-grabber (Debian: mrpt-apps) is absent";
    }

    /** With a standard input that stays open and empty: it ends at the first key. */
    ProgramRun grab(const std::string& ini)
    {
        const std::string no_keys = folder_ / "no_keys";
        mkfifo(no_keys.c_str(), 0600);  // or it is there already
        return runProgram(
            "timeout 120 rawlog-grabber",
            std::string("-p ") + TAUT_GRABBER + " " + ini + " <>" + no_keys);
    }

    /** config/grabber/pcap-replay.ini with the capture and other values put in. */
    std::string replayOf(const fs::path& pcap, std::map<std::string, std::string> values)
    {
        std::string text = contentOf(TAUT_CONFIG "/grabber/pcap-replay.ini");
        values["pcap_input"] = pcap.string();
        values["rawlog_prefix"] = folder_ / "captured";
        for (const auto& [key, value] : values)
        {
            const std::regex line("(^|\n)" + key + " *=[^\n]*");
            EXPECT_TRUE(std::regex_search(text, line)) << key;
            text = std::regex_replace(text, line, "$1" + key + " = " + value);
        }
        const std::string ini = folder_ / "replay.ini";
        std::ofstream(ini) << text;
        return ini;
    }

    /** Plays a capture of the data folder; false where that is absent. */
    bool replay(const std::string& name, const std::map<std::string, std::string>& values = {})
    {
        const fs::path pcap = dataFolder() / "pcap" / (name + ".pcap");
        if (!fs::exists(pcap)) return false;
        facts_ =
            nlohmann::json::parse(std::ifstream(dataFolder() / "pcap" / (name + ".facts.json")));
        run_ = grab(replayOf(pcap, values));
        read();
        return true;
    }

    /** The rawlog that was written, and what it holds. */
    void read()
    {
        for (const auto& file : fs::directory_iterator(folder_ / "."))
            if (file.path().extension() == ".rawlog") config_.path = file.path().string();
        ASSERT_FALSE(config_.path.empty()) << run_.output;
        RawlogSource source(config_, [this](const Warning& w) { warnings_ += w.kind + " "; });
        while (auto measurement = source.next())
        {
            if (auto* scan = std::get_if<Scan>(&*measurement)) scans_.push_back(std::move(*scan));
            if (auto* sample = std::get_if<ImuSample>(&*measurement)) imu_.push_back(*sample);
        }
        progress_ = source.progress();
    }

    const TemporaryFolder folder_;
    nlohmann::json facts_;
    ProgramRun run_;
    RawlogConfig config_;
    StreamProgress progress_;
    std::vector<Scan> scans_;
    ImuSamples imu_;
    std::string warnings_;
};

TEST_F(RawlogGrabber, WritesEveryReturnOfAVlp16)
{
    if (!replay("vlp16_5hz", {{"pose_z", "1.5"}, {"lidar_label", "TOP"}}))
        return skipWithout("vlp16_5hz.pcap");
    EXPECT_THAT(run_.output, HasSubstr("all of its 19 scans and 0 IMU samples are written"));
    EXPECT_EQ(warnings_, "");
    ASSERT_EQ(scans_.size(), facts_["zero_crossings"].get<std::size_t>() + 1);
    EXPECT_EQ(progress_.points, facts_["valid_returns_total"]);
    EXPECT_EQ(progress_.lidar_label, "TOP");
    EXPECT_EQ(scans_[0].T_imu_lidar.p.z(), 1.5);  // without an IMU, the vehicle is the body
    const Duration hour = 3'600'000'000'000;
    EXPECT_EQ(scans_[0].stamp % hour, facts_["device_us_first"].get<Time>() * 1000);

    ASSERT_EQ(slam(config_.path, folder_ / "out").exit_code, 0);
    const Trajectory trajectory = readTum(folder_ / "out/trajectory.tum");
    ASSERT_EQ(trajectory.size(), 19U);
    for (const StampedPose& pose : trajectory)  // the sensor is on its stand
        EXPECT_LT(
            (pose.T_world_imu.p - trajectory[0].T_world_imu.p).norm(), 0.04);  // measured: 0.025 m
}

TEST_F(RawlogGrabber, StampsAsTheCapturingComputerDidWhereTold)
{
    if (!replay("vlp16_gps", {{"capture_clock", "true"}, {"speed", "0"}}))
        return skipWithout("vlp16_gps.pcap");
    ASSERT_EQ(scans_.size(), facts_["zero_crossings"].get<std::size_t>() + 1);
    EXPECT_EQ(progress_.points, facts_["valid_returns_total"]);
    EXPECT_NEAR(toSeconds(scans_[0].stamp), facts_["pcap_time_first"].get<double>(), 0.002);
}

TEST_F(RawlogGrabber, WritesEveryFrameAndSampleOfAnOuster)
{
    if (!replay("ouster_os1_128", {{"speed", "0"}})) return skipWithout("ouster_os1_128.pcap");
    EXPECT_THAT(run_.output, HasSubstr("all of its 3 scans and 30 IMU samples are written"));
    const auto& frames = facts_["frames"];
    ASSERT_EQ(scans_.size(), frames.size());
    const Duration shift = scans_[0].stamp - frames[0]["t_first_ns"].get<Time>();
    for (std::size_t i = 0; i < frames.size(); i++)
    {
        EXPECT_EQ(scans_[i].points.size(), frames[i]["valid_returns"]);
        EXPECT_LE(std::abs(scans_[i].stamp - shift - frames[i]["t_first_ns"].get<Time>()), 100);
    }
    ASSERT_EQ(imu_.size(), facts_["imu_packets"]);
    EXPECT_LE(std::abs(imu_.back().t - shift - facts_["imu_last_ns"].get<Time>()), 100);
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(scans_[0].T_imu_lidar.p[i], facts_["T_imu_lidar"][i][3].get<double>(), 1e-9);

    ASSERT_EQ(slam(config_.path, folder_ / "out").exit_code, 0);
    const Trajectory trajectory = readTum(folder_ / "out/trajectory.tum");
    ASSERT_EQ(trajectory.size(), 3U);
    EXPECT_NEAR((trajectory[2].T_world_imu.p - trajectory[0].T_world_imu.p).norm(), 0.498, 0.01);
}

TEST_F(RawlogGrabber, SaysSoWhereTheCaptureIsCutOff)
{
    const fs::path pcap = dataFolder() / "pcap/vlp16_gps.pcap";
    if (!fs::exists(pcap)) return skipWithout("vlp16_gps.pcap");
    const std::string cut = folder_ / "cut.pcap";
    fs::copy_file(pcap, cut);
    fs::permissions(cut, fs::perms::owner_all);
    fs::resize_file(cut, fs::file_size(cut) / 2);
    run_ = grab(replayOf(cut, {{"speed", "0"}}));
    EXPECT_THAT(run_.output, HasSubstr("pcap_truncated"));
    EXPECT_THAT(run_.output, HasSubstr("the warnings tell what of the capture could not be used"));
    read();
    EXPECT_EQ(scans_.size(), 3U);
}

// What taut-info says of it is what it says of the same capture imported.
TEST_F(RawlogGrabber, WritesWhatTautImportWrites)
{
    if (!replay("ouster_os1_128", {{"speed", "0"}})) return skipWithout("ouster_os1_128.pcap");
    const std::string imported = folder_ / "imported.log";
    const fs::path pcap = dataFolder() / "pcap/ouster_os1_128.pcap";
    ASSERT_EQ(runProgram(TAUT_IMPORT, pcap.string() + " -o " + imported).exit_code, 0);
    RawlogConfig config;
    config.path = imported;
    RawlogSource source(config);
    std::size_t scan = 0, sample = 0;
    while (const auto measurement = source.next())
    {
        if (const auto* s = std::get_if<ImuSample>(&*measurement))
        {
            ASSERT_LT(sample, imu_.size());
            EXPECT_EQ(s->t, imu_[sample].t);
            EXPECT_EQ(s->accel, imu_[sample].accel);
            EXPECT_EQ(s->gyro, imu_[sample++].gyro);
            continue;
        }
        const auto& s = std::get<Scan>(*measurement);
        ASSERT_LT(scan, scans_.size());
        EXPECT_EQ(s.stamp, scans_[scan].stamp);
        EXPECT_EQ(s.end, scans_[scan].end);
        ASSERT_EQ(s.points.size(), scans_[scan].points.size());
        for (std::size_t i = 0; i < s.points.size(); i++)
        {
            ASSERT_EQ(s.points[i].position, scans_[scan].points[i].position);
            ASSERT_EQ(s.points[i].offset, scans_[scan].points[i].offset);
        }
        scan++;
    }
    EXPECT_EQ(scan, scans_.size());
    EXPECT_EQ(sample, imu_.size());
    const ProgramRun told = runProgram(TAUT_INFO, config_.path + " -q");
    EXPECT_EQ(told.exit_code, runProgram(TAUT_INFO, imported + " -q").exit_code) << told.output;
    EXPECT_THAT(told.exit_code, testing::AnyOf(0, 3)) << told.output;
}

TEST_F(RawlogGrabber, IsToldWhatIsWrongWithACapture)
{
    EXPECT_THAT(
        grab(replayOf(folder_ / "none.pcap", {})).output, HasSubstr("none.pcap' is not there"));
    std::ofstream(folder_ / "text.pcap") << "hello";
    EXPECT_THAT(
        grab(replayOf(folder_ / "text.pcap", {})).output,
        HasSubstr("no recording that can be imported"));
    EXPECT_THAT(
        grab(replayOf(folder_ / "text.pcap", {{"speed", "-1"}})).output, HasSubstr("speed"));
    EXPECT_THAT(grab(replayOf("", {})).output, HasSubstr("no pcap_input"));
}
}  // namespace
