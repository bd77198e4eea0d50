#include "taut/files/PlyFile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "temporary_folder.h"

using namespace taut;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

namespace
{
void writeText(const std::string& path, const std::string& text)
{
    std::ofstream(path, std::ios::binary) << text;
}

std::string readText(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

template <class T>
std::string bytesOf(T value)
{
    return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

class PlyFile : public ::testing::Test
{
 protected:
    /** Expects that reading all points of this text fails with that message, naming the file. */
    void expectError(const std::string& text, const std::string& message)
    {
        writeText(path_, text);
        EXPECT_THAT(
            [&] { readPlyPoints(path_); },
            ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path_), HasSubstr(message))));
    }

    test::TemporaryFolder folder_;
    const std::string path_ = folder_ / "cloud.ply";
};
}  // namespace

TEST_F(PlyFile, WrittenPointsAreReadBackUnchanged)
{
    PlyPointWriter writer(path_);
    for (int i = 0; i < 10000; ++i)  // more than one buffer of the reader
    {
        const auto f = static_cast<float>(i);
        writer.append({{f, -0.1F * f, 1e-3F * f}, f / 7});
    }
    EXPECT_EQ(writer.size(), 10000U);
    writer.close();

    const auto points = readPlyPoints(path_);
    ASSERT_EQ(points.size(), 10000U);
    EXPECT_EQ(points[9999].position, Eigen::Vector3f(9999, -0.1F * 9999, 1e-3F * 9999));
    EXPECT_EQ(points[9999].intensity, 9999.F / 7);
    EXPECT_EQ(points[4096].position.x(), 4096);
}

TEST_F(PlyFile, AnEmptyCloudIsAFileOfNoPoints)
{
    PlyPointWriter(path_).close();
    EXPECT_TRUE(readPlyPoints(path_).empty());
}

TEST_F(PlyFile, AWriterThatGoesOutOfScopeHasClosedTheFile)
{
    {
        PlyPointWriter writer(path_);
        writer.append({});
    }
    EXPECT_EQ(readPlyPoints(path_).size(), 1U);
}

TEST_F(PlyFile, AFileIsWholeAfterEachFlush)
{
    PlyPointWriter writer(path_);
    EXPECT_TRUE(readPlyPoints(path_).empty());
    for (int i = 0; i < 1000; i++) writer.append({});  // what a stream would not hold back
    EXPECT_TRUE(readPlyPoints(path_).empty());
    writer.flush();
    EXPECT_EQ(readPlyPoints(path_).size(), 1000U);
    writer.append({});
    writer.flush();
    EXPECT_EQ(readPlyPoints(path_).size(), 1001U);
}

TEST_F(PlyFile, AFileWithMoreThanItsHeaderStatesIsRefused)
{
    PlyPointWriter writer(path_);
    writer.append({});
    writer.close();
    std::string text = readText(path_);
    text.replace(text.find("vertex 1"), 8, "vertex 0");
    expectError(text, "holds more data than the 0 vertices");
}

TEST_F(PlyFile, ATruncatedFileIsRefusedWithTheNumberOfPointsThere)
{
    PlyPointWriter writer(path_);
    for (int i = 0; i < 10; ++i) writer.append({});
    writer.close();
    const std::string text = readText(path_);
    expectError(text.substr(0, text.size() - 20), "ends after 8 of 10 vertices");
}

TEST_F(PlyFile, AsciiWithOtherPropertiesElementsAndLineEndsIsRead)
{
    writeText(
        path_,
        "ply\r\nformat ascii 1.0\r\ncomment hand made\r\nobj_info none\r\nelement vertex 2\r\n"
        "property uchar red\r\nproperty float intensity\r\nproperty double z\r\nproperty float "
        "y\r\n"
        "property float x\r\nelement face 1\r\nproperty list uchar int vertex_indices\r\n"
        "end_header\r\n255 0.5 3 2 1\r\n0 1.5 -3e2 -2 -1\r\n3 0 1 0\r\n");
    const auto points = readPlyPoints(path_);
    ASSERT_EQ(points.size(), 2U);
    EXPECT_EQ(points[0].position, Eigen::Vector3f(1, 2, 3));
    EXPECT_EQ(points[1].position, Eigen::Vector3f(-1, -2, -300));
    EXPECT_EQ(points[0].intensity, 0.5F);
}

TEST_F(PlyFile, EveryNumberTypeIsDecoded)
{
    writeText(
        path_,
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty char a\nproperty uint8 "
        "b\n"
        "property short c\nproperty ushort d\nproperty int e\nproperty uint f\nproperty float32 g\n"
        "property double h\nend_header\n" +
            bytesOf<std::int8_t>(-1) + bytesOf<std::uint8_t>(200) + bytesOf<std::int16_t>(-300) +
            bytesOf<std::uint16_t>(60000) + bytesOf<std::int32_t>(-70000) +
            bytesOf<std::uint32_t>(4000000000U) + bytesOf(0.25F) + bytesOf(1e-9));
    PlyReader reader(path_);
    EXPECT_EQ(reader.size(), 1U);
    EXPECT_EQ(reader.column("d"), 3);
    EXPECT_EQ(reader.column("time"), -1);
    std::vector<double> row;
    ASSERT_TRUE(reader.next(row));
    EXPECT_THAT(
        row, ::testing::ElementsAre(-1, 200, -300, 60000, -70000, 4000000000.0, 0.25, 1e-9));
    EXPECT_FALSE(reader.next(row));
}

TEST_F(PlyFile, MalformedFilesGiveTheirCause)
{
    const std::string head = "ply\nformat ascii 1.0\n";
    expectError("", "does not begin with 'ply'");
    expectError("plywood\n", "does not begin with 'ply'");
    expectError("ply\nformat binary_big_endian 1.0\n", "'binary_big_endian' is not supported");
    expectError(head + "element vertex 1\n" + kXyz, "without 'end_header'");
    expectError(head + "end_header\n", "states no vertices");
    expectError("ply\nelement vertex 1\n" + kXyz + "end_header\n", "states no format");
    expectError(head + "element vertex many\n", "bad number of vertices");
    expectError(head + "element vertex -1\n" + kXyz + "end_header\n", "ends after 0 of");
    expectError(head + "element face 1\n", "'face' before the vertices");
    expectError(head + "nonsense\n", "unknown line in the header: 'nonsense'");
    expectError(head + "element vertex 1\nproperty list int int x\n", "'property list int int x'");
    expectError(head + "element vertex 1\nproperty float\n", "is not supported");
    expectError(head + "element vertex 1\nproperty float x\nend_header\n1\n", "no property 'y'");
    const std::string two = head + "element vertex 2\n" + kXyz + "end_header\n";
    expectError(two + "1 2 3\n", "ends after 1 of 2 vertices");
    expectError(two + "1 2 3\n1 x 3\n", "vertex 1 is not a row of numbers: '1 x 3'");
    expectError(two + "1 2 3\n1 2\n", "vertex 1 is not a row of numbers");
    expectError(two + "1 2 3\n1 2 3\n1 2 3\n", "holds more data than the 2 vertices");
    EXPECT_THAT(
        [&] { readPlyPoints(folder_ / "none.ply"); },
        ThrowsMessage<std::runtime_error>(HasSubstr("cannot be opened")));
}

TEST_F(PlyFile, TheWriterRefusesWhatItCannotWrite)
{
    EXPECT_THAT(
        [&] { PlyPointWriter(folder_ / "no/such/folder.ply"); },
        ThrowsMessage<std::runtime_error>(HasSubstr("cannot be written")));
    PlyPointWriter writer(path_);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(
        [&] {
            writer.append({{0, nan, 0}, 0});
        },
        ThrowsMessage<std::runtime_error>(HasSubstr("point 0 is not finite")));
    writer.close();
    EXPECT_THAT(
        [&] { writer.append({}); }, ThrowsMessage<std::runtime_error>(HasSubstr("is closed")));
    EXPECT_TRUE(readPlyPoints(path_).empty());
}

TEST_F(PlyFile, AFullDiskIsAnError)
{
    std::ofstream probe("/dev/full");
    if (!probe) GTEST_SKIP() << "no /dev/full here";
    EXPECT_THAT(
        []
        {
            PlyPointWriter writer("/dev/full");
            for (int i = 0; i < 100000; ++i) writer.append({});
            writer.close();
        },
        ThrowsMessage<std::runtime_error>(HasSubstr("cannot be written: No space left on device")));
}
