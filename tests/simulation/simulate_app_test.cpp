#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "program.h"
#include "taut/core/Geometry.h"
#include "taut/files/MeshFile.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/simulation/RayCaster.h"
#include "taut/trajectory/Interpolation.h"
#include "taut/trajectory/PointTruth.h"
#include "taut/trajectory/TrajectoryFile.h"
#include "temporary_folder.h"

using namespace taut;
using ::testing::HasSubstr;

namespace
{
test::ProgramRun run(const std::string& arguments)
{
    return test::runProgram(TAUT_SIMULATE, arguments);
}

std::string contentOf(const std::string& path)
{
    std::ostringstream out;
    out << std::ifstream(path, std::ios::binary).rdbuf();
    return out.str();
}

struct Recording
{
    std::vector<Scan> scans;
    ImuSamples samples;
    std::vector<std::string> warnings;
};

Recording read(const std::string& path)
{
    Recording r;
    RawlogConfig config;
    config.path = path;
    RawlogSource source(config, [&r](const Warning& w) { r.warnings.push_back(w.kind); });
    while (const auto m = source.next())
    {
        if (const auto* scan = std::get_if<Scan>(&*m))
            r.scans.push_back(*scan);
        else
            r.samples.push_back(std::get<ImuSample>(*m));
    }
    return r;
}

class SimulateApp : public testing::Test
{
 protected:
    /** A second of violent motion, unless the arguments say otherwise. */
    test::ProgramRun simulate(const std::string& arguments, const std::string& name = "log")
    {
        return run(
            "-c " TAUT_SCENARIOS "/hall_violent.yaml --set rest=0 --set duration=1 -o " +
            (folder_ / (name + ".rawlog")) + " " + arguments);
    }
    std::string file(const std::string& name) const { return folder_ / name; }

    test::TemporaryFolder folder_;
};

/** Truth of the points against their measured positions and the true trajectory, as a reader has
 * them. Returns the number of points compared. */
std::size_t checkPointTruth(const std::string& log, double tolerance)
{
    const Recording recording = read(log + ".rawlog");
    const Trajectory trajectory = readTum(log + ".gt.tum");
    const TrajectoryInterpolator truth(trajectory);
    PointTruthReader points(log + ".points");
    std::size_t compared = 0;
    for (const Scan& scan : recording.scans)
    {
        UndistortedScan undistorted;
        EXPECT_TRUE(points.next(undistorted));
        EXPECT_NEAR(static_cast<double>(undistorted.stamp - scan.end), 0, 100);
        EXPECT_EQ(undistorted.positions.size(), scan.points.size());
        const auto T_end = truth.at(scan.end);
        if (!T_end || undistorted.positions.size() != scan.points.size()) continue;
        for (std::size_t i = 0; i < scan.points.size(); i += 53)
        {
            const auto T = truth.at(scan.timeOf(scan.points[i]));
            if (!T) continue;
            const Vector3d expected =
                T_end->inverse() * (*T * scan.T_imu_lidar * scan.points[i].position.cast<double>());
            EXPECT_LT((undistorted.positions[i].cast<double>() - expected).norm(), tolerance);
            compared++;
        }
    }
    return compared;
}
}  // namespace

TEST_F(SimulateApp, WritesARawlogThatReadsBack)
{
    const test::ProgramRun r = simulate("");
    ASSERT_EQ(r.exit_code, 0) << r.output;
    EXPECT_THAT(r.output, HasSubstr("200 IMU samples"));
    const Recording recording = read(file("log.rawlog"));
    EXPECT_EQ(recording.samples.size(), 200U);
    ASSERT_EQ(recording.scans.size(), 9U);
    EXPECT_TRUE(recording.warnings.empty());
    EXPECT_EQ(recording.scans[0].rings, 16);
    EXPECT_GT(recording.scans[0].T_imu_lidar.p.norm(), 0.05);
    EXPECT_EQ(readTum(file("log.gt.tum")).size(), 200U);
}

TEST_F(SimulateApp, TruthOfPointsIsTheirPlaceAtTheEndOfTheScan)
{
    ASSERT_EQ(simulate("--points --quiet --set imu.rate=2000").exit_code, 0);
    EXPECT_GT(checkPointTruth(file("log"), 2e-4), 3000U);  // interpolation between 0.5 ms
}

TEST_F(SimulateApp, TruthIsFreeOfTheErrorsOfBeamsAndMountInPacketsToo)
{
    const std::string errors =
        "--points --quiet --set lidar.beam_error=0.002 --set lidar.range_bias=0.05 "
        "--set lidar.mount_error.roll=3 --set lidar.mount_error.x=0.1 "
        "--set lidar.soft_mount.frequency=30 --set lidar.soft_mount.angle=0.01";
    ASSERT_EQ(simulate(errors).exit_code, 0);
    ASSERT_EQ(simulate(errors + " --packets", "packets").exit_code, 0);
    PointTruthReader plain(file("log.points")), packets(file("packets.points"));
    UndistortedScan a, b;
    while (plain.next(a) && packets.next(b))
    {
        ASSERT_EQ(a.positions.size(), b.positions.size());
        for (std::size_t i = 0; i < a.positions.size(); i += 17)
            EXPECT_LT((a.positions[i] - b.positions[i]).norm(), 0.02F);
    }
    EXPECT_GT(a.positions.size(), 10000U);
}

TEST_F(SimulateApp, PacketsHoldTheSamePoints)
{
    ASSERT_EQ(simulate("--points --quiet --set imu.rate=2000 --packets").exit_code, 0);
    EXPECT_GT(checkPointTruth(file("log"), 3e-4), 3000U);
    ASSERT_EQ(simulate("--quiet", "plain").exit_code, 0);
    const Recording packets = read(file("log.rawlog")), plain = read(file("plain.rawlog"));
    ASSERT_EQ(packets.scans.size(), plain.scans.size());
    for (std::size_t k = 0; k < plain.scans.size(); k++)
    {
        const Scan &a = packets.scans[k], &b = plain.scans[k];
        ASSERT_EQ(a.points.size(), b.points.size());
        for (std::size_t i = 0; i < a.points.size(); i += 17)
        {
            EXPECT_EQ(a.points[i].ring, b.points[i].ring);
            EXPECT_NEAR(
                static_cast<double>(a.timeOf(a.points[i]) - b.timeOf(b.points[i])), 0, 1200);
            // 0.01 degrees at up to 40 m
            EXPECT_LT((a.points[i].position - b.points[i].position).norm(), 0.009F);
        }
    }
}

TEST_F(SimulateApp, SameSeedSameBits)
{
    ASSERT_EQ(simulate("--quiet --points --threads 1 --set duration=0.5", "a").exit_code, 0);
    ASSERT_EQ(simulate("--quiet --points --threads 3 --set duration=0.5", "b").exit_code, 0);
    ASSERT_EQ(simulate("--quiet --points --seed 2 --set duration=0.5", "c").exit_code, 0);
    for (const std::string ending : {".rawlog", ".gt.tum", ".biases.csv", ".points"})
    {
        EXPECT_EQ(contentOf(file("a" + ending)), contentOf(file("b" + ending))) << ending;
        EXPECT_NE(contentOf(file("a" + ending)), contentOf(file("c" + ending))) << ending;
    }
}

TEST_F(SimulateApp, WritesTheWorldThatTheBeamsHit)
{
    ASSERT_EQ(simulate("--quiet --points --mesh").exit_code, 0);
    const TriangleMesh world = readMesh(file("log.mesh.ply"));
    simulation::Mesh mesh;
    mesh.vertices = world.vertices;
    mesh.triangles = world.triangles;
    mesh.reflectivity.assign(mesh.triangles.size(), 0.5F);
    const simulation::RayCaster caster(mesh);
    const Trajectory trajectory = readTum(file("log.gt.tum"));
    const TrajectoryInterpolator truth(trajectory);
    PointTruthReader points(file("log.points"));
    UndistortedScan scan;
    std::size_t near = 0, all = 0;
    while (points.next(scan))
    {
        const auto T = truth.at(scan.stamp);
        if (!T) continue;
        for (std::size_t i = 0; i < scan.positions.size(); i += 53, all++)
            near += caster.clearance(*T * scan.positions[i].cast<double>(), 0.08) < 0.08 ? 1 : 0;
    }
    ASSERT_GT(all, 1000U);
    // Noise is 2 cm at most; the rest are people and mixed pixels.
    EXPECT_GT(static_cast<double>(near), 0.97 * static_cast<double>(all));
    EXPECT_EQ(simulate("--quiet --mesh --set duration=0.5").exit_code, 0) << "replaces its own";
    std::ofstream(file("log.mesh.ply")) << "ply\nformat binary_little_endian 1.0\ncomment mine\n";
    EXPECT_EQ(simulate("--quiet --mesh").exit_code, 2);
    EXPECT_THAT(contentOf(file("log.mesh.ply")), HasSubstr("mine"));
}

TEST_F(SimulateApp, FaultsReachTheReader)
{
    ASSERT_EQ(
        simulate("--quiet --points --set faults.nan_points=0.1 --set faults.repeated_stamps=0.2 "
                 "--set faults.time_jump.at=0.5 --set faults.time_jump.by=-0.25")
            .exit_code,
        0);
    const Recording recording = read(file("log.rawlog"));
    EXPECT_THAT(recording.warnings, testing::Contains("scan_bad_points"));
    EXPECT_THAT(recording.warnings, testing::Contains("imu_time"));
    PointTruthReader points(file("log.points"));
    UndistortedScan truth;
    for (const Scan& scan : recording.scans)
    {
        while (points.next(truth) && truth.stamp < scan.end - 1000)
        {
        }
        ASSERT_NEAR(static_cast<double>(truth.stamp - scan.end), 0, 1000);
        EXPECT_EQ(truth.positions.size(), scan.points.size()) << "in the order of the finite ones";
    }
}

TEST_F(SimulateApp, ReplaysATrajectory)
{
    ASSERT_EQ(simulate("--quiet --duration 3", "first").exit_code, 0);
    const test::ProgramRun r = simulate(
        "--quiet --set motion.type=replay --set motion.smoothing=0.02 --set motion.file=" +
            file("first.gt.tum"),
        "again");
    ASSERT_EQ(r.exit_code, 0) << r.output;
    const Trajectory first = readTum(file("first.gt.tum")), again = readTum(file("again.gt.tum"));
    for (std::size_t i = 20; i < again.size(); i++)
        EXPECT_LT((again[i].T_world_imu.p - first[i].T_world_imu.p).norm(), 0.03) << i;
}

TEST_F(SimulateApp, ReplacesRecordingsAndNothingElse)
{
    ASSERT_EQ(simulate("--quiet --points").exit_code, 0);
    ASSERT_EQ(simulate("--quiet --points --seed 2").exit_code, 0);
    for (const auto& entry : std::filesystem::directory_iterator(file("")))
        EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    std::ofstream(file("log.gt.tum")) << "mine";
    std::ofstream(file("notes")) << "mine";
    EXPECT_EQ(simulate("--quiet").exit_code, 2);
    EXPECT_EQ(contentOf(file("log.gt.tum")), "mine");
    EXPECT_EQ(run("-c " TAUT_SCENARIOS "/hall_violent.yaml -o " + file("notes")).exit_code, 2);
    EXPECT_EQ(contentOf(file("notes")), "mine");
}

TEST_F(SimulateApp, NeverOverwritesWhatItReads)
{
    ASSERT_EQ(simulate("--quiet --duration 3", "first").exit_code, 0);
    const std::string truth = contentOf(file("first.gt.tum"));
    const test::ProgramRun replay = simulate(
        "--quiet --set motion.type=replay --set motion.file=" + file("first.gt.tum"), "first");
    EXPECT_EQ(replay.exit_code, 2) << replay.output;
    EXPECT_EQ(contentOf(file("first.gt.tum")), truth);
    std::filesystem::copy_file(TAUT_SCENARIOS "/hall_violent.yaml", file("scenario.yaml"));
    std::filesystem::create_symlink(file("scenario.yaml"), file("link.rawlog"));
    const std::string scenario = contentOf(file("scenario.yaml"));
    EXPECT_EQ(run("-c " + file("scenario.yaml") + " -o " + file("link.rawlog")).exit_code, 2);
    EXPECT_EQ(contentOf(file("scenario.yaml")), scenario);
}

TEST_F(SimulateApp, SavesWhatWasDoneWhenInterrupted)
{
    const std::string log = file("log.rawlog");
    const pid_t child = fork();
    if (child == 0)
    {
        execl(
            TAUT_SIMULATE, TAUT_SIMULATE, "-q", "-c", TAUT_SCENARIOS "/hall_violent.yaml", "-o",
            log.c_str(), "--duration", "600", nullptr);
        _exit(127);
    }
    for (int i = 0; i < 2000; i++)  // until sweeps are written
    {
        const bool begun = std::filesystem::exists(log + ".part") &&
                           std::filesystem::file_size(log + ".part") > 100'000;
        if (begun) break;
        usleep(10'000);
    }
    kill(child, SIGTERM);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 3);
    EXPECT_GT(read(log).scans.size(), 0U);
    EXPECT_FALSE(std::filesystem::exists(log + ".part"));
}

TEST_F(SimulateApp, SaysWhatIsWrong)
{
    EXPECT_EQ(run("--help").exit_code, 0);
    EXPECT_EQ(run("").exit_code, 2);
    EXPECT_EQ(simulate("--set imu.rat=3").exit_code, 2);
    EXPECT_THAT(simulate("--set imu.rat=3").output, HasSubstr("'imu.rat'"));
    EXPECT_EQ(simulate("--packets --set lidar.type=OS1-64").exit_code, 2);
    EXPECT_EQ(run("-c /nowhere.yaml -o /tmp/x.rawlog").exit_code, 2);
    EXPECT_EQ(
        run("-c " TAUT_SCENARIOS "/hall_violent.yaml --duration 1 -o /nowhere/x.rawlog").exit_code,
        1);
    EXPECT_EQ(simulate("--set motion.height=0.1").exit_code, 1);
}
