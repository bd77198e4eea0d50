/** taut-import as a user runs it, and taut-slam on what it wrote. */
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "data_folder.h"
#include "slam_program.h"
#include "taut/core/TimeText.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/rawlog/RawlogWriter.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;
using testing::HasSubstr;
namespace fs = std::filesystem;

ProgramRun import(const std::string& arguments)
{
    return runProgram(TAUT_IMPORT, arguments);
}

template <class T>
void put(std::ofstream& file, T value)
{
    file.write(reinterpret_cast<const char*>(&value), sizeof value);
}

/** x, y, z, ring and, if wanted, time, binary. */
void writePly(const std::string& path, const Scan& scan, bool times)
{
    std::ofstream file(path, std::ios::binary);
    file << "ply\nformat binary_little_endian 1.0\nelement vertex " << scan.points.size()
         << "\nproperty float x\nproperty float y\nproperty float z\nproperty ushort ring\n"
         << (times ? "property int dt_ns\n" : "") << "end_header\n";
    for (const LidarPoint& p : scan.points)
    {
        for (int i = 0; i < 3; i++) put(file, p.position[i]);
        put(file, p.ring);
        if (times) put(file, p.offset);
    }
}

/** The sample as a plain folder, up to a time, with the IMU in g and deg/s. */
void writeFolder(const std::string& folder, double to_time, bool times = true)
{
    fs::create_directories(folder);
    RawlogConfig config;
    config.path = kSample;
    config.to_time = to_time;
    RawlogSource source(config);
    std::ofstream imu(folder + "/imu.csv");
    imu << "t gyro_x gyro_y gyro_z accel_x accel_y accel_z\n";
    imu.precision(12);
    while (const auto measurement = source.next())
    {
        if (const auto* scan = std::get_if<Scan>(&*measurement))
        {
            writePly(folder + "/" + formatSeconds(scan->stamp) + ".ply", *scan, times);
            continue;
        }
        const auto& s = std::get<ImuSample>(*measurement);
        imu << formatSeconds(s.t);
        for (int i = 0; i < 3; i++) imu << " " << s.gyro[i] * 180 / M_PI;
        for (int i = 0; i < 3; i++) imu << " " << s.accel[i] / 9.80665;
        imu << "\n";
    }
}

/** Where the sample's LiDAR is on its IMU, which a plain folder does not tell. */
void writeRig(const std::string& path)
{
    RawlogConfig config;
    config.path = kSample;
    RawlogSource source(config);
    while (const auto measurement = source.next())
    {
        const auto* scan = std::get_if<Scan>(&*measurement);
        if (!scan) continue;
        const Pose& T = scan->T_imu_lidar;
        const double degree = M_PI / 180;
        std::ofstream(path) << "lidar: {pose: {x: " << T.p.x() << ", y: " << T.p.y()
                            << ", z: " << T.p.z()
                            << ", yaw: " << std::atan2(T.R(1, 0), T.R(0, 0)) / degree
                            << ", pitch: " << std::asin(-T.R(2, 0)) / degree
                            << ", roll: " << std::atan2(T.R(2, 1), T.R(2, 2)) / degree << "}}\n";
        return;
    }
}

TEST(AnImport, OfAPlainFolderLosesNoAccuracy)
{
    const TemporaryFolder folder;
    const std::string in = folder / "in", log = folder / "log.rawlog", out = folder / "out";
    writeFolder(in, 30);
    writeRig(folder / "rig.yaml");
    const ProgramRun run = import(in + " -o " + log + " -r " + (folder / "rig.yaml"));
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("124 in"));
    EXPECT_THAT(run.output, HasSubstr("specific force in g, converted"));
    EXPECT_THAT(run.output, HasSubstr("rates in deg/s, converted"));
    ASSERT_EQ(slam(log, out).exit_code, 0);
    // The sample itself: 0.82 mm.
    EXPECT_LT(positionError(kSampleTruth, out + "/trajectory.tum"), 0.0012);  // measured: 0.75 mm
}

TEST(AnImport, OfCloudsWithoutTimesTakesThemFromTheAzimuth)
{
    const TemporaryFolder folder;
    const std::string in = folder / "in", log = folder / "log.rawlog", out = folder / "out";
    writeFolder(in, 30, false);
    writeRig(folder / "rig.yaml");
    const std::string arguments = in + " -w -o " + log + " -r " + (folder / "rig.yaml");
    const ProgramRun run = import(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("times of the points: from their azimuth, clockwise"));
    EXPECT_THAT(run.output, HasSubstr("stamp of a sweep: taken as its start, for then the gyro"));
    ASSERT_EQ(slam(log, out).exit_code, 0);
    // With times: 0.82 mm.
    EXPECT_LT(positionError(kSampleTruth, out + "/trajectory.tum"), 0.0016);

    const ProgramRun none = import(arguments + " --scan-times none");
    EXPECT_EQ(none.exit_code, 0) << none.output;
    EXPECT_THAT(none.output, HasSubstr("taken as already undistorted"));
    EXPECT_EQ(import(arguments + " --scan-times never").exit_code, 2);
}

// One command instead of two, to the bit.
TEST(ARecordingOfAnotherFormat, IsRunAsTheRawlogThatAnImportMakesOfIt)
{
    const TemporaryFolder folder;
    const std::string in = folder / "in", log = folder / "log.rawlog", rig = folder / "rig.yaml";
    writeFolder(in, 6);
    writeRig(rig);
    std::ofstream(rig, std::ios::app) << "imu: {pose: {x: 0.25, yaw: 90}}\n";
    ASSERT_EQ(import(in + " -o " + log + " -r " + rig).exit_code, 0);
    const std::string part = "--from-time 1 --only-first-n 20";
    ASSERT_EQ(slam(log, folder / "two", part).exit_code, 0);
    const ProgramRun run = slam(in, folder / "one", part + " -r " + rig);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    for (const char* file : {"/trajectory.tum", "/map.ply", "/states.csv"})
        EXPECT_TRUE(contentOf(folder / "one" + file) == contentOf(folder / "two" + file)) << file;
    EXPECT_THAT(run.output, HasSubstr("LiDAR 'LIDAR': "));
    EXPECT_THAT(run.output, HasSubstr("rates in deg/s, converted"));
    const std::string metrics = contentOf(folder / "one/metrics.json");
    EXPECT_THAT(metrics, HasSubstr("specific force in g, converted"));
    EXPECT_THAT(metrics, HasSubstr("\"sha256\": null"));
    for (const auto& file : fs::directory_iterator(folder / "one"))
        EXPECT_NE(file.path().extension(), ".rawlog") << file.path();
}

TEST(ARecordingOfAnotherFormat, NamesTheFolderOfTheResults)
{
    const TemporaryFolder folder;
    writeFolder(folder / "hall.1", 1);
    fs::create_directories(folder / "work");
    const std::string slam_there = "cd " + (folder / "work") + " && " TAUT_SLAM;
    const auto run = [&](const std::string& arguments)
    { return runProgram(slam_there, arguments + " -q --no-pictures --no-report --threads 1"); };
    EXPECT_EQ(run("../hall.1/").exit_code, 0);
    EXPECT_TRUE(fs::exists(folder / "work/hall.1_taut/trajectory.tum"));
    const ProgramRun again = run("../hall.1");
    EXPECT_EQ(again.exit_code, 2);
    EXPECT_THAT(again.output, HasSubstr("'hall.1_taut' holds results already; -w overwrites"));
    EXPECT_EQ(run("--only-first-n 5 -i " + kSample).exit_code, 0);
    EXPECT_TRUE(fs::exists(folder / "work/hall_fast_taut/trajectory.tum"));
}

TEST(ARecordingOfAnotherFormat, ThatLacksAPartGivesThreeAndTheRest)
{
    const TemporaryFolder folder;
    const std::string in = folder / "in";
    writeFolder(in, 1);
    std::ofstream(in + "/9999999999.000000000.ply") << "ply\nno more";
    const ProgramRun run = slam(in, folder / "out");
    EXPECT_EQ(run.exit_code, 3) << run.output;
    EXPECT_THAT(run.output, HasSubstr("warning [scan_invalid]"));
    EXPECT_THAT(contentOf(folder / "out/metrics.json"), HasSubstr("\"skipped_observations\": 1"));
}

TEST(ARecordingOfAnotherFormat, HasOptionsThatARawlogHasNot)
{
    const TemporaryFolder folder;
    const std::string in = folder / "in", out = folder / "out";
    writeFolder(in, 0.5);
    const auto says = [](const std::string& log, const std::string& to, const std::string& more)
    {
        const ProgramRun run = slam(log, to, more);
        EXPECT_EQ(run.exit_code, 2) << run.output;
        return run.output;
    };
    EXPECT_THAT(says(kSample, out, "--imu-topic /imu"), HasSubstr("--imu-topic is for captures"));
    EXPECT_THAT(says(in, out, "--imu XSENS"), HasSubstr("in a bag --lidar-topic and --imu-topic"));
    EXPECT_THAT(says(in, out, "--scan-stamp middle"), HasSubstr("--scan-stamp is start or end"));
    EXPECT_THAT(says(in, in, "-w"), HasSubstr("choose another folder"));
    EXPECT_FALSE(fs::exists(out));
    EXPECT_FALSE(fs::exists(in + "/trajectory.tum"));
    EXPECT_EQ(slam(folder / "absent.bag", out, "--imu-topic /imu").exit_code, 1);
}

TEST(AnImport, IsRefusedWithOneLineAndLeavesNothing)
{
    const TemporaryFolder folder;
    const std::string log = folder / "log.rawlog";
    std::ofstream(folder / "text") << "hello";
    std::ofstream(folder / "head.pcap") << "\xd4\xc3\xb2\xa1 and no more";
    fs::create_directories(folder / "empty");
    for (const char* source : {"none", "text", "head.pcap", "empty"})
    {
        const ProgramRun run = import((folder / source) + " -o " + log);
        EXPECT_EQ(run.exit_code, 1) << source;
        EXPECT_THAT(run.output, HasSubstr(source));
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
        EXPECT_FALSE(fs::exists(log)) << source;
    }
}

TEST(AnImport, GivesTwoForBadUsageAndOverwritesOnlyWhenTold)
{
    const TemporaryFolder folder;
    const std::string log = folder / "log.rawlog", in = folder / "in";
    EXPECT_EQ(import("").exit_code, 2);
    EXPECT_EQ(import(in).exit_code, 2);
    EXPECT_EQ(import("--help").exit_code, 0);
    writeFolder(in, 0.5);
    RawlogWriter writer(log);
    writer.write(ImuSample{});
    writer.close();
    const std::string before = contentOf(log);
    EXPECT_EQ(import(in + " -o " + log).exit_code, 2);
    EXPECT_EQ(contentOf(log), before);
    EXPECT_EQ(import(in + " -w -o " + log).exit_code, 0);
    EXPECT_GT(contentOf(log).size(), 10000U);
}

TEST(AnImport, NeverDestroysWhatItReadsNorWhatIsNoRawlog)
{
    const TemporaryFolder folder;
    const std::string in = folder / "in";
    writeFolder(in, 0.5);
    std::ofstream(folder / "rig.yaml") << "imu: {label: 'IMU'}\n";
    std::ofstream(folder / "log.rawlog.part") << "mine";
    fs::copy_file(kSample, folder / "source.rawlog");
    fs::create_symlink(folder / "source.rawlog", folder / "link.rawlog");
    fs::create_hard_link(folder / "source.rawlog", folder / "second.rawlog");
    const auto refuses = [&](const std::string& source, const std::string& output)
    {
        const std::string before = contentOf(output);
        const ProgramRun run = import(source + " -w -r " + (folder / "rig.yaml") + " -o " + output);
        EXPECT_EQ(run.exit_code, 2) << output << ": " << run.output;
        EXPECT_THAT(run.output, HasSubstr(output));
        EXPECT_EQ(contentOf(output), before) << output;
    };
    for (const char* output : {"source.rawlog", "link.rawlog", "second.rawlog"})
        refuses(folder / "source.rawlog", folder / output);
    refuses(folder / "log.rawlog.part", folder / "log.rawlog");
    EXPECT_EQ(contentOf(folder / "log.rawlog.part"), "mine");
    refuses(in, folder / "rig.yaml");
    refuses(in, in + "/imu.csv");
}

TEST(AnImport, DoesNotWriteWhatAnotherIsWriting)
{
    const TemporaryFolder folder;
    const std::string in = folder / "in", log = folder / "log.rawlog";
    writeFolder(in, 0.5);
    RawlogWriter other(log);
    other.write(ImuSample{});
    const ProgramRun run = import(in + " -o " + log);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.output, HasSubstr("another program"));
    other.close();
    EXPECT_TRUE(isRawlog(log));
}

TEST(AnImport, ThatLacksAPartGivesThreeAndWritesTheRest)
{
    const TemporaryFolder folder;
    const std::string log = folder / "log.rawlog", in = folder / "in";
    writeFolder(in, 0.5);
    fs::remove(in + "/imu.csv");
    const ProgramRun run = import(in + " -o " + log);
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.output, HasSubstr("no_imu"));
    EXPECT_TRUE(fs::exists(log));
}

TEST(AnImport, WritesPosesAndLabelsAsTold)
{
    const TemporaryFolder folder;
    const std::string log = folder / "log.rawlog", in = folder / "in", rig = folder / "rig.yaml";
    writeFolder(in, 0.5);
    std::ofstream(rig) << "lidar: {label: 'front', pose: {x: 1, z: 2}, clock_offset: 0.25}\n"
                          "imu: {pose: {z: 0.5}}\n";
    const std::string labels = " --lidar-label front --imu-label body ";
    ASSERT_EQ(import(in + labels + "-r " + rig + " -o " + log).exit_code, 0);
    RawlogConfig config;
    config.path = log;
    RawlogSource source(config);
    std::optional<Scan> scan;
    while (const auto measurement = source.next())
        if (!scan && std::holds_alternative<Scan>(*measurement))
            scan = std::get<Scan>(*measurement);
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->sensor_label, "front");
    EXPECT_EQ(source.progress().imu_label, "body");
    EXPECT_LT((scan->T_imu_lidar.p - Vector3d(1, 0, 1.5)).norm(), 1e-9);
    config.path = kSample;
    RawlogSource sample(config);
    std::optional<Scan> first;
    while (!first)
        if (const auto m = sample.next(); std::holds_alternative<Scan>(*m))
            first = std::get<Scan>(*m);
    EXPECT_NEAR(toSeconds(scan->stamp - first->stamp), 0.25, 1e-4);

    std::ofstream(rig) << "lidar: {label: 'rear', pose: {x: 1, z: 2}}\n";
    const ProgramRun run = import(in + labels + "-w -r " + rig + " -o " + log);
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.output, HasSubstr("rig_unused"));
}

// imu.csv is a pipe: when it has swallowed more than it can hold, the program has read the samples.
TEST(AnInterruptedImport, SavesWhatWasRead)
{
    const TemporaryFolder folder;
    const std::string in = folder / "in", log = folder / "log.rawlog";
    writeFolder(in, 13);
    const auto clouds = static_cast<std::size_t>(
        std::distance(fs::directory_iterator(in), fs::directory_iterator()));
    const pid_t child = fork();
    if (child == 0)
    {
        execl(TAUT_IMPORT, TAUT_IMPORT, in.c_str(), "-q", "-o", log.c_str(), nullptr);
        _exit(127);
    }
    // As soon as it writes.
    const auto bytesWritten = [&]
    {
        std::uintmax_t bytes = 0;
        std::error_code gone;
        for (const auto& file : fs::directory_iterator(folder / ""))
            if (file.path().filename().string().rfind("log.rawlog", 0) == 0)
                if (const auto size = file.file_size(gone); !gone) bytes += size;
        return bytes;
    };
    for (int i = 0; i < 60'000 && bytesWritten() < 20'000; i++)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(child, SIGINT);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 3);
    RawlogConfig config;
    config.path = log;
    RawlogSource source(config);
    while (source.next())
    {
    }
    EXPECT_FALSE(source.incomplete());
    EXPECT_GT(source.progress().scans, 0U);
    EXPECT_LT(source.progress().scans, clouds);
}

class ACapture : public testing::Test
{
 protected:
    /** Imports it and runs taut-slam; false where it is absent. */
    bool run(const std::string& name)
    {
        const auto pcap = dataFolder() / "pcap" / (name + ".pcap");
        if (!fs::exists(pcap)) return false;
        const std::string log = folder_ / "log.rawlog";
        const ProgramRun imported = import(pcap.string() + " -o " + log);
        EXPECT_EQ(imported.exit_code, 0) << imported.output;
        const ProgramRun run = slam(log, folder_ / "out");
        EXPECT_EQ(run.exit_code, 0) << run.output;
        trajectory_ = readTum(folder_ / "out/trajectory.tum");
        return true;
    }

    const TemporaryFolder folder_;
    Trajectory trajectory_;
};

TEST_F(ACapture, OfAVlp16OnItsStandStaysWhereItIs)
{
    if (!run("vlp16_5hz")) return skipWithout("vlp16_5hz.pcap");
    ASSERT_EQ(trajectory_.size(), 19U);
    // Without an IMU, so the speed over the first sweep is unknown at first. Measured: 0.025 m.
    for (const auto& state : trajectory_)
        EXPECT_LT((state.T_world_imu.p - trajectory_[0].T_world_imu.p).norm(), 0.04);
}

// The facts beside the capture say 0.498 m, by another program.
TEST_F(ACapture, OfAnOusterMovesAsFarAsItsFactsSay)
{
    if (!run("ouster_os1_128")) return skipWithout("ouster_os1_128.pcap");
    ASSERT_EQ(trajectory_.size(), 3U);
    EXPECT_NEAR((trajectory_[2].T_world_imu.p - trajectory_[0].T_world_imu.p).norm(), 0.498, 0.01);
}

TEST_F(ACapture, CutOffGivesThreeAndWhatIsThere)
{
    const auto pcap = dataFolder() / "pcap/vlp16_gps.pcap";
    if (!fs::exists(pcap)) return skipWithout("vlp16_gps.pcap");
    const std::string cut = folder_ / "cut.pcap";
    fs::copy_file(pcap, cut);
    fs::permissions(cut, fs::perms::owner_all);
    fs::resize_file(cut, fs::file_size(cut) / 2);
    const ProgramRun run = import(cut + " -o " + (folder_ / "log.rawlog"));
    EXPECT_EQ(run.exit_code, 3) << run.output;
    EXPECT_THAT(run.output, HasSubstr("pcap_truncated"));
    EXPECT_TRUE(fs::exists(folder_ / "log.rawlog"));
}
}  // namespace
