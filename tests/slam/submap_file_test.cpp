#include "taut/submaps/SubmapFile.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>

#include "any_submap.h"
#include "taut/submaps/SubmapStore.h"
#include "temporary_folder.h"

using namespace taut;
using namespace taut::test;

namespace
{
bool sameBits(const Pose& a, const Pose& b)
{
    return a.R == b.R && a.p == b.p;
}

void expectSame(const Submap& a, const Submap& b)
{
    EXPECT_EQ(a.id, b.id);
    EXPECT_TRUE(sameBits(a.T_world_submap, b.T_world_submap));
    EXPECT_EQ(a.up_submap, b.up_submap);
    EXPECT_EQ(a.up_covariance, b.up_covariance);
    EXPECT_EQ(a.path_begin, b.path_begin);
    EXPECT_EQ(a.path_end, b.path_end);
    EXPECT_EQ(a.reach, b.reach);
    EXPECT_EQ(a.doubtful, b.doubtful);
    ASSERT_EQ(a.scans.size(), b.scans.size());
    for (std::size_t i = 0; i < a.scans.size(); i++)
    {
        EXPECT_EQ(a.scans[i].t, b.scans[i].t);
        EXPECT_TRUE(sameBits(a.scans[i].T_submap_imu, b.scans[i].T_submap_imu));
        EXPECT_EQ(a.scans[i].covariance, b.scans[i].covariance);
    }
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); i++)
    {
        EXPECT_EQ(a.points[i].position, b.points[i].position);
        EXPECT_EQ(a.points[i].scan, b.points[i].scan);
    }
    ASSERT_EQ(a.key_scans.size(), b.key_scans.size());
    for (std::size_t i = 0; i < a.key_scans.size(); i++)
    {
        EXPECT_TRUE(sameBits(a.key_scans[i].T_submap_sensor, b.key_scans[i].T_submap_sensor));
        EXPECT_EQ(a.key_scans[i].scan, b.key_scans[i].scan);
        EXPECT_EQ(a.key_scans[i].blur, b.key_scans[i].blur);
        EXPECT_EQ(a.key_scans[i].image.cells(), b.key_scans[i].image.cells());
    }
}

std::string contentOf(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write(const std::string& path, const std::string& content)
{
    std::ofstream(path, std::ios::binary) << content;
}

/** What is wrong with a file; empty: nothing. */
std::string faultOf(const std::string& path)
{
    try
    {
        readSubmap(path);
        return "";
    }
    catch (const std::runtime_error& e)
    {
        return e.what();
    }
}
}  // namespace

TEST(ASubmapFile, GivesBackEveryBit)
{
    const TemporaryFolder folder;
    const Submap submap = anySubmap(3);
    writeSubmap(folder / "3.tsm", submap);
    expectSame(readSubmap(folder / "3.tsm"), submap);
    EXPECT_FALSE(std::filesystem::exists(folder / "3.tsm.part"));
}

TEST(ASubmapFile, ThatIsDamagedIsRefused)
{
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsm";
    writeSubmap(path, anySubmap(1));
    const std::string good = contentOf(path);
    Random random(9);
    for (int i = 0; i < 300; i++)
    {
        std::string bad = good;
        const auto at =
            static_cast<std::size_t>(random.uniform(0, static_cast<double>(good.size() - 1)));
        if (i % 2 == 0)
            bad.resize(at);
        else
            bad[at] = static_cast<char>(bad[at] ^ (1 << (i % 8)));
        write(path, bad);
        EXPECT_NE(faultOf(path), "") << i << " at " << at;
    }
    std::string newer = good;
    newer[7] = '9';
    write(path, newer);
    EXPECT_NE(faultOf(path).find("another version"), std::string::npos) << faultOf(path);
    write(path, "");
    EXPECT_NE(faultOf(path).find("no submap"), std::string::npos);
    EXPECT_NE(faultOf(folder / "none.tsm").find("No such file"), std::string::npos);
}

TEST(ASubmapFile, TakesNoMemoryForASizeThatIsDamaged)
{
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsm";
    writeSubmap(path, anySubmap(1));
    std::string bad = contentOf(path);
    bad[11] = 0x30;  // 768 MB, of data that the checksum does not cover
    write(path, bad);
    const auto peak = []  // [kB]
    {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return usage.ru_maxrss;
    };
    const long before = peak();
    EXPECT_NE(faultOf(path).find("damaged"), std::string::npos) << faultOf(path);
    EXPECT_LT(peak() - before, 300'000);
}

TEST(ASubmapFile, ThatCannotBeWrittenIsAnError)
{
    EXPECT_THROW(writeSubmap("/nowhere/1.tsm", anySubmap(1)), std::runtime_error);
}

TEST(ASubmapStore, GivesWhatItWasGivenHoweverLittleItHolds)
{
    const TemporaryFolder folder;
    SubmapStore store(folder / "submaps", 2);
    for (VertexId id = 0; id < 6; id++) store.add(anySubmap(id));
    for (const VertexId id : {0, 5, 3, 3, 1, 0, 4}) expectSame(*store.at(id), anySubmap(id));
    EXPECT_THROW(store.at(17), std::runtime_error);
}
