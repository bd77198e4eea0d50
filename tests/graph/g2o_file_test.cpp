#include "taut/graph/G2oFile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "graphs.h"
#include "taut/graph/GraphResiduals.h"
#include "temporary_folder.h"

using namespace taut;
using namespace taut::test;

namespace
{
PoseGraph sample()
{
    PoseGraph graph = anyGraph(12, 1, true).graph;
    graph.relative_edges[4].enabled = false;
    graph.relative_edges.back().enabled = false;
    graph.vertices[7].fixed = true;
    for (GraphVertex& v : graph.vertices)
        v.T_world_submap.R = normalizedRotation(v.T_world_submap.R);
    for (RelativeEdge& e : graph.relative_edges) e.T_from_to.R = normalizedRotation(e.T_from_to.R);
    graph.vertices[3].T_world_submap.R = expSO3({M_PI, 0, 0});
    return graph;
}

std::string contentOf(const std::string& path)
{
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

void write(const std::string& path, const std::string& text)
{
    std::ofstream(path) << text;
}

std::string identity(int size)
{
    std::string text;
    for (int i = 0; i < size; i++)
        for (int j = i; j < size; j++) text += i == j ? " 1" : " 0";
    return text;
}

const std::string kTwo =
    "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
    "VERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\n"
    "VERTEX_SE3:QUAT 2 2 0 0 0 0 0 1\n";
}  // namespace

TEST(G2oFile, BringsAGraphBack)
{
    const TemporaryFolder folder;
    const PoseGraph graph = sample();
    writeG2o(folder / "graph.g2o", graph);
    const PoseGraph back = readG2o(folder / "graph.g2o");
    ASSERT_EQ(back.vertices.size(), graph.vertices.size());
    ASSERT_EQ(back.relative_edges.size(), graph.relative_edges.size());
    ASSERT_EQ(back.gravity_edges.size(), graph.gravity_edges.size());
    for (std::size_t i = 0; i < graph.vertices.size(); i++)
    {
        const GraphVertex &a = graph.vertices[i], &b = back.vertices[i];
        EXPECT_EQ(a.id, b.id);
        EXPECT_EQ(a.fixed, b.fixed);
        EXPECT_EQ(a.T_world_submap.p, b.T_world_submap.p);  // to the bit
        EXPECT_LT((a.T_world_submap.R - b.T_world_submap.R).cwiseAbs().maxCoeff(), 2e-15);
    }
    for (std::size_t i = 0; i < graph.relative_edges.size(); i++)
    {
        const RelativeEdge &a = graph.relative_edges[i], &b = back.relative_edges[i];
        EXPECT_EQ(a.from, b.from);
        EXPECT_EQ(a.to, b.to);
        EXPECT_EQ(a.kind, b.kind);
        EXPECT_EQ(a.enabled, b.enabled);
        EXPECT_EQ(a.T_from_to.p, b.T_from_to.p);
        EXPECT_LT((a.T_from_to.R - b.T_from_to.R).cwiseAbs().maxCoeff(), 2e-15);
        // To the bit: the factors are powers of two.
        EXPECT_EQ(
            Matrix6d(a.information.triangularView<Eigen::Upper>()),
            Matrix6d(b.information.triangularView<Eigen::Upper>()));
        EXPECT_EQ(b.information, b.information.transpose());
    }
    for (std::size_t i = 0; i < graph.gravity_edges.size(); i++)
    {
        const GravityEdge &a = graph.gravity_edges[i], &b = back.gravity_edges[i];
        EXPECT_EQ(a.vertex, b.vertex);
        EXPECT_EQ(a.up_submap, b.up_submap);
        EXPECT_EQ(
            Matrix3d(a.information.triangularView<Eigen::Upper>()),
            Matrix3d(b.information.triangularView<Eigen::Upper>()));
    }
}

/** g2o's error of an edge: translation and vector part of the quaternion of z^-1 (i^-1 j). */
TEST(G2oFile, ChiSquareOfG2oIsThatOfTheEdge)
{
    const TemporaryFolder folder;
    const PoseGraph graph = anyGraph(12, 1, false).graph;
    writeG2o(folder / "graph.g2o", graph);
    std::ifstream file(folder / "graph.g2o");
    std::size_t edges = 0;
    for (std::string line; std::getline(file, line);)
    {
        std::istringstream words(line);
        std::string tag;
        VertexId from, to;
        words >> tag;
        if (tag != "EDGE_SE3:QUAT") continue;
        Vector3d p;
        Eigen::Quaterniond q;
        words >> from >> to >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z() >> q.w();
        Matrix6d information;
        for (int i = 0; i < 6; i++)
            for (int j = i; j < 6; j++)
            {
                words >> information(i, j);
                information(j, i) = information(i, j);
            }
        ASSERT_TRUE(words);
        // An error small enough for the quaternion's vector part to be half the angle.
        const Vector6d d = 1e-5 * (Vector6d() << 3, -2, 1, 2, -4, 3).finished();
        const Pose z{q.toRotationMatrix(), p};
        const Pose gap = z.inverse() * (z * exp(d));
        Eigen::Quaterniond turn(gap.R);
        if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
        Vector6d g2o_error;
        g2o_error << gap.p, turn.vec();
        const RelativeEdge& e = graph.relative_edges[edges++];
        const Vector6d r = relativeResidual(e.T_from_to, Pose{}, e.T_from_to * exp(d));
        const double chi2 = r.dot(e.information * r);
        EXPECT_NEAR(g2o_error.dot(information * g2o_error), chi2, 1e-6 * chi2);
    }
    EXPECT_EQ(edges, graph.relative_edges.size());
}

TEST(G2oFile, ReadsFilesOfOtherPrograms)
{
    const TemporaryFolder folder;
    write(
        folder / "other.g2o", "# made elsewhere\r\nPARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n\n" + kTwo +
                                  "FIX 0\nEDGE_SE3:QUAT 0 1 1 0 0 0 0 0 0.999" + identity(6) +
                                  "\nEDGE_SE3:QUAT 2 0 -2 0 0 0 0 0 1" + identity(6) + "\n");
    const PoseGraph graph = readG2o(folder / "other.g2o");
    ASSERT_EQ(graph.vertices.size(), 3u);
    ASSERT_EQ(graph.relative_edges.size(), 2u);
    EXPECT_TRUE(graph.vertices[0].fixed);
    EXPECT_FALSE(graph.vertices[1].fixed);
    EXPECT_EQ(graph.relative_edges[0].kind, EdgeKind::Odometry);
    EXPECT_EQ(graph.relative_edges[1].kind, EdgeKind::LoopClosure);
    EXPECT_EQ(graph.relative_edges[0].T_from_to.R, Matrix3d::Identity());
    // Information 1 of the quaternion's vector part is 1/4 of the rotation vector.
    EXPECT_EQ(
        graph.relative_edges[1].information.diagonal(),
        (Vector6d() << 1, 1, 1, 0.25, 0.25, 0.25).finished());
}

TEST(G2oFile, DamagedFilesAreRefusedWithTheLine)
{
    const TemporaryFolder folder;
    const std::string path = folder / "bad.g2o";
    const std::string edge = "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1";
    struct Fault
    {
        std::string text, message;
    };
    std::string indefinite = identity(6);
    indefinite.replace(indefinite.find('1'), 1, "-1");
    const std::vector<Fault> faults{
        {kTwo + edge + "\n", ":4: 31 words expected, found 10"},
        {kTwo + edge + identity(6) + " 3\n", ":4: 31 words expected"},
        {kTwo + "EDGE_SE3:QUAT 0 9 1 0 0 0 0 0 1" + identity(6), ":4: vertex 9 is not known"},
        {kTwo + "EDGE_SE3:QUAT 1 1 1 0 0 0 0 0 1" + identity(6), ":4: .*same vertex"},
        {kTwo + "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 7" + identity(6), ":4: the quaternion"},
        {kTwo + "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 0" + identity(6), ":4: the quaternion"},
        {kTwo + "EDGE_SE3:QUAT 0 1 nan 0 0 0 0 0 1" + identity(6), ":4: 'nan' is not finite"},
        {kTwo + "EDGE_SE3:QUAT 0 1 1,5 0 0 0 0 0 1" + identity(6), ":4: '1,5' is not a number"},
        {kTwo + "EDGE_SE3:QUAT 0 1.5 1 0 0 0 0 0 1" + identity(6), ":4: '1.5' is not a number"},
        {kTwo + edge + indefinite, ":4: .*not positive semi-definite"},
        {kTwo + "VERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n", ":4: vertex 1 is given twice"},
        {kTwo + "VERTEX_SE3:QUAT 3 0 0 0 0 0 0\n", ":4: 9 words expected"},
        {kTwo + "FIX 7\n", ":4: vertex 7 is not known"},
        {kTwo + "FIX\n", ":4: FIX names no vertex"},
        {kTwo + "VERTEX_SE2 3 0 0 0\n", ":4: 'VERTEX_SE2' is no element"},
        {kTwo + "\x01\x02\x7f\n", ":4: .*is no element"},
        {kTwo + "#taut gravity 0 0 0 9.81" + identity(3), ":4: .*not a unit vector"},
        {kTwo + "#taut gravity 0 0 0 1 1\n", ":4: 12 words expected"},
        {kTwo + "#taut magic\n", ":4: a comment of taut"},
        {kTwo + "#taut loop_closure\n", ":4: a loop closure is missing"},
        {kTwo + "#taut disabled maybe " + edge + identity(6), ":4: 'maybe' is no kind"}};
    for (const Fault& fault : faults)
    {
        write(path, fault.text);
        try
        {
            readG2o(path);
            ADD_FAILURE() << "accepted: " << fault.text;
        }
        catch (const std::runtime_error& e)
        {
            EXPECT_THAT(e.what(), ::testing::ContainsRegex("bad.g2o" + fault.message));
        }
    }
    EXPECT_THROW(readG2o(folder / "absent.g2o"), std::runtime_error);
}

TEST(G2oFile, AFileCutAnywhereIsRefused)
{
    const TemporaryFolder folder;
    writeG2o(folder / "graph.g2o", sample());
    const std::string whole = contentOf(folder / "graph.g2o");
    const std::size_t header = whole.find('\n') + 1;
    const std::size_t last_number = whole.find_last_of(' ');
    for (std::size_t length = header; length < last_number; length += 37)
    {
        write(folder / "cut.g2o", whole.substr(0, length));
        EXPECT_THROW(readG2o(folder / "cut.g2o"), std::runtime_error) << length;
    }
}

TEST(G2oFile, WritesNoFileThatNobodyCouldRead)
{
    const TemporaryFolder folder;
    PoseGraph graph = sample();
    graph.relative_edges[0].to = 99;
    EXPECT_THROW(writeG2o(folder / "graph.g2o", graph), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(folder / "graph.g2o"));
    EXPECT_THROW(writeG2o(folder / "no/such/folder.g2o", sample()), std::runtime_error);
}
