#include <lzf.h>
#include <zlib.h>

#include "../graph/graphs.h"
#include "../slam/any_submap.h"
#include "seeds.h"
#include "support.h"
#include "taut/files/PlyFile.h"
#include "taut/graph/G2oFile.h"
#include "taut/submaps/SubmapFile.h"
#include "taut/trajectory/PointTruth.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace taut::fuzz
{
using namespace taut::test;
namespace fs = std::filesystem;

namespace
{
constexpr Time kBegin = 1'700'000'000'000'000'000;

Trajectory path()
{
    Trajectory path;
    for (int i = 0; i < 20; i++)
        path.push_back(
            {kBegin + i * Time{100'000'000}, {expSO3({0, 0, 0.1 * i}), {0.1 * i, 2, 3}}});
    return path;
}

std::string row(float x, double t)
{
    std::string bytes(reinterpret_cast<const char*>(&x), sizeof x);
    for (int i = 0; i < 2; i++) bytes.append(reinterpret_cast<const char*>(&x), sizeof x);
    bytes += '\7';
    bytes.append(reinterpret_cast<const char*>(&t), sizeof t);
    return bytes;
}

/** The data of a PCD file, compressed. */
std::string packed(const std::string& data)
{
    std::string bytes(2 * data.size() + 100, '\0');
    const std::uint32_t whole = static_cast<std::uint32_t>(data.size());
    const std::uint32_t size =
        lzf_compress(data.data(), whole, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    return std::string(reinterpret_cast<const char*>(&size), sizeof size) +
           std::string(reinterpret_cast<const char*>(&whole), sizeof whole) + bytes.substr(0, size);
}

void addClouds(const Seeds& seeds)
{
    const std::string ply =
        "1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty "
        "uchar intensity\nproperty double t\nend_header\n";
    const std::string pcd =
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity t\nSIZE 4 4 4 1 8\nTYPE F F F U F\n"
        "COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ";
    const std::string text = "1 2 3 7 1700000000.25\n4 5 6 8 1700000000.5\n";
    const std::string binary = row(1, 1700000000.25) + row(2, 1700000000.5);
    seeds.add("ply", "text", "ply\nformat ascii " + ply + text);
    seeds.add("ply", "binary", "ply\nformat binary_little_endian " + ply + binary);
    seeds.add("pcd", "text", pcd + "ascii\n" + text);
    seeds.add("pcd", "binary", pcd + "binary\n" + binary);
    seeds.add("pcd", "compressed", pcd + "binary_compressed\n" + packed(std::string(42, '\1')));
    PlyPointWriter writer(seeds.file("ply", "map"));
    for (const float x : {0.f, 1.f, 2.f}) writer.append({{x, 2, 3}, 10 * x});
    writer.close();
    seeds.add(
        "cloud_csv", "commas",
        std::string("x,y,z,intensity,ring,t\n1,2,3,4,0,1700000000.25\n1,2,4,5,1,1700000000.3\n"));
    seeds.add("cloud_csv", "blanks", std::string("# x y z t_ns\n1 2 3 0\n1 2 4 100000\n"));
    const std::string columns = "gyro_x,gyro_y,gyro_z,accel_x,accel_y,accel_z\n";
    seeds.add(
        "imu_csv", "seconds",
        "t," + columns + "1700000000.1,0,0,0.1,0,0,9.81\n1700000000.11,0,0,0.1,0,0,9.81\n");
    seeds.add(
        "imu_csv", "nanoseconds",
        "t_ns," + columns +
            "1700000000100000000,0,0,0.1,0,0,1\n# a comment\n1700000000110000000,0,0,0.1,0,0,1\n");
    seeds.add(
        "mesh", "pyramid.obj",
        std::string("# a pyramid\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nf 1/1 2/2 3/3 "
                    "4/4\nf 1 2 5\nf -3 -2 -1\n"));
    const std::string faces =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    seeds.add(
        "mesh", "text.ply", "ply\nformat ascii 1.0\n" + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    std::string bytes(36, '\0');
    bytes += std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
    seeds.add("mesh", "binary.ply", "ply\nformat binary_little_endian 1.0\n" + faces + bytes);
}

void addTrajectories(const Seeds& seeds)
{
    std::string tum = "# t x y z qx qy qz qw\n", kitti, times;
    for (const StampedPose& pose : path())
    {
        tum += tumLine(pose) + "\n";
        kitti += kittiLine(pose.T_world_imu) + "\n";
        times += formatSeconds(pose.t) + "\n";
    }
    seeds.add("trajectory", "tum", "T" + tum);
    seeds.add("trajectory", "kitti", "K" + joinPieces(std::vector<std::string>{times}) + kitti);
    seeds.add(
        "trajectory", "euroc",
        std::string("E#timestamp, p_RS_R_x [m], ...\n1403636580838555648,4.5,-1.25,0.5,0.6,0,0.8,0,"
                    "0.1,0.2\n1403636580843555328,4.5,-1.5,0.5,1,0,0,0,0.1,0.2\r\n"));
    PointTruthWriter points(seeds.file("point_truth", "two_scans"));
    for (int i = 0; i < 2; i++)
        points.write({kBegin + i * Time{100'000'000}, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}});
    points.close();
}

/** As metrics.json and the tables of a run are. */
void addResults(const Seeds& seeds)
{
    const std::string graph = seeds.file("graph", "loops");
    writeG2o(graph, anyGraph(4, 1, true).graph);
    seeds.add(
        "graph", "foreign",
        std::string("PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
                    "VERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\nFIX 0\nEDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 "
                    "1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 4 0 0 4 0 4\n"));
    const std::string file = seeds.file("submap", "file");
    writeSubmap(file, anySubmap(0, 20, 0));
    const std::string stored = contentOf(file);
    seeds.add("submap", "file", '\0' + stored);
    for (const int key_scans : {0, 1})
    {
        const std::string name = "data_" + std::to_string(key_scans);
        writeSubmap(seeds.file("submap", name), anySubmap(1, 20, key_scans));
        const std::string whole = contentOf(seeds.file("submap", name));
        std::uint32_t size = 0;
        std::memcpy(&size, whole.data() + 8, 4);
        std::string data(size, '\0');
        uLongf written = size;
        uncompress(
            reinterpret_cast<Bytef*>(data.data()), &written,
            reinterpret_cast<const Bytef*>(whole.data() + 16), whole.size() - 16);
        seeds.add("submap", name, '\1' + data);
    }
    std::string tum;
    for (const StampedPose& pose : path()) tum += tumLine(pose) + "\n";
    seeds.add(
        "run_report", "all",
        joinPieces(std::vector<std::string>{
            tum,
            R"({"input": {"file": "a/log.rawlog", "duration_s": 2, "incomplete": false},
"warnings": {"imu_gap": 4}, "first_warnings": [{"t": 1700000001.5, "kind": "imu_gap", "text": "no"}],
"doubtful": [{"from": 1700000001, "to": 1700000002, "cause": "imu_silent", "recovered": true}],
"time": {"mean_ms_per_scan": 12.5}, "slam": {"loops_accepted": 1}})",
            "t,ba_x,var_ba_x,correspondences,fit\n1700000000,0.1,0.04,20,0.9\n1700000000.1,0.2,0."
            "01,"
            "0,0\n",
            "t,total_ms\n1700000000,12.5\n",
            "from,to,verdict,reason,gap_m\n0,1,accepted,\"surfaces, and views\",0.5\n",
            contentOf(seeds.file("ply", "map")), contentOf(graph), "map: {}\n", stored}));
}

void addConfigurations(const Seeds& seeds, const fs::path& source)
{
    for (const char* name : {"default.yaml", "paper.yaml"})
        seeds.add("method", name, contentOf(source / "config" / name));
    seeds.add("rig", "example", contentOf(source / "config/rig-example.yaml"));
    for (const auto& entry : fs::directory_iterator(source / "config/scenarios"))
        if (entry.path().extension() == ".yaml")
            seeds.add("scenario", entry.path().filename(), contentOf(entry.path()));
}
}  // namespace

void addFileSeeds(const Seeds& seeds, const fs::path& source)
{
    addClouds(seeds);
    addTrajectories(seeds);
    addResults(seeds);
    addConfigurations(seeds, source);
}
}  // namespace taut::fuzz
