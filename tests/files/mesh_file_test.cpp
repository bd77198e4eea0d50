#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "taut/files/MeshFile.h"
#include "taut/files/PlyFile.h"
#include "temporary_folder.h"

using namespace taut;
using ::testing::HasSubstr;

namespace
{
const TriangleMesh kTetrahedron{
    {{0, 0, 0}, {1.0 / 3, 0, 0}, {0, 1e6 + 0.1, 0}, {0, 0, -1e-9}},
    {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}};

std::string errorOf(const std::string& path)
{
    try
    {
        readMesh(path);
    }
    catch (const std::runtime_error& e)
    {
        return e.what();
    }
    return "no error";
}
}  // namespace

TEST(MeshFile, ReadsWhatItWroteToTheBit)
{
    const test::TemporaryFolder folder;
    const std::string path = folder / "mesh.ply";
    writeMesh(path, kTetrahedron, "four faces");
    const TriangleMesh mesh = readMesh(path);
    EXPECT_EQ(mesh.vertices, kTetrahedron.vertices);
    EXPECT_EQ(mesh.triangles, kTetrahedron.triangles);
    std::string begin(meshFileStart("four faces").size(), '\0');
    std::ifstream(path).read(begin.data(), static_cast<std::streamsize>(begin.size()));
    EXPECT_EQ(begin, meshFileStart("four faces"));
    EXPECT_EQ(readPlyPoints(path).size(), 4U) << "a reader of clouds takes the vertices";
}

TEST(MeshFile, WithoutFacesIsACloud)
{
    const test::TemporaryFolder folder;
    const std::string path = folder / "cloud.ply";
    PlyPointWriter writer(path);
    writer.append({{1, 2, 3}, 9});
    writer.append({{4, 5, 6}, 9});
    writer.close();
    const TriangleMesh cloud = readMesh(path);
    EXPECT_TRUE(cloud.triangles.empty());
    EXPECT_EQ(cloud.vertices, (std::vector<Eigen::Vector3d>{{1, 2, 3}, {4, 5, 6}}));
}

TEST(MeshFile, NamesFileAndCause)
{
    const test::TemporaryFolder folder;
    const std::string path = folder / "bad.ply";
    const auto with = [&](const std::string& content)
    {
        std::ofstream(path) << content;
        return errorOf(path);
    };
    const std::string header = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
    const std::string rest = "property float y\nproperty float z\nend_header\n";
    EXPECT_THAT(with(header + rest + "1 2 nan\n"), HasSubstr("not finite"));
    EXPECT_THAT(with(header + rest + "1 2 x\n"), HasSubstr("'x' is no number"));
    EXPECT_THAT(with(header + rest + "1 2\n"), HasSubstr("bad.ply': it ends early"));
    EXPECT_THAT(with(header + "end_header\n1\n"), HasSubstr("lack x, y or z"));
    EXPECT_THAT(with("ply\nelement vertex many\nend_header\n"), HasSubstr("'element vertex many'"));
    EXPECT_THAT(with("v 1 2\n"), HasSubstr("line 1 is no vertex"));
    EXPECT_EQ(with("v 1 2 3"), "no error");
    EXPECT_THROW(writeMesh(folder / "none/mesh.ply", kTetrahedron, "x"), std::runtime_error);
}

TEST(MeshFile, SaysWhenTheDiskIsFull)
{
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "/dev/full is absent";
    EXPECT_THROW(writeMesh("/dev/full", kTetrahedron, "x"), std::runtime_error);
}
