#include <gmock/gmock.h>

#include <filesystem>
#include <limits>
#include <stdexcept>

#include "las_reader.h"
#include "taut/files/LasFile.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kTime = 1'700'000'000 * kSecond;

class ALasFile : public testing::Test
{
 protected:
    const TemporaryFolder folder_;
    const std::string path_ = folder_ / "map.las";
};

TEST_F(ALasFile, HasTheHeaderOfItsPoints)
{
    LasPointWriter writer(path_);
    EXPECT_TRUE(writer.append({{1.5, -2, 3}, 0, kTime}));
    EXPECT_TRUE(writer.append({{-4, 5.25, 0.5}, 255, kTime + kSecond}));
    writer.close();
    const LasFile las(path_);
    EXPECT_EQ(las.bytes.substr(0, 4), "LASF");
    EXPECT_EQ(las.at<std::uint16_t>(6), 1);  // adjusted standard GPS time
    EXPECT_EQ(las.at<std::uint8_t>(24), 1);
    EXPECT_EQ(las.at<std::uint8_t>(25), 2);
    EXPECT_EQ(las.at<std::uint16_t>(94), 227);
    EXPECT_EQ(las.at<std::uint32_t>(96), 227U);
    EXPECT_EQ(las.at<std::uint32_t>(100), 0U);  // variable length records
    EXPECT_EQ(las.at<std::uint8_t>(104), 1);
    EXPECT_EQ(las.at<std::uint16_t>(105), 28);
    EXPECT_EQ(las.points(), 2U);
    EXPECT_EQ(las.at<std::uint32_t>(111), 2U);  // first returns
    EXPECT_EQ(las.at<std::uint32_t>(115), 0U);
    const double low[] = {-4, -2, 0.5}, high[] = {1.5, 5.25, 3};
    for (std::size_t axis = 0; axis < 3; axis++)
    {
        EXPECT_EQ(las.at<double>(131 + 8 * axis), 0.001);
        EXPECT_EQ(las.at<double>(155 + 8 * axis), 0.0);
        EXPECT_DOUBLE_EQ(las.min(axis), low[axis]);
        EXPECT_DOUBLE_EQ(las.max(axis), high[axis]);
    }
    EXPECT_EQ(las.bytes.size(), 227U + 2 * 28);
}

TEST_F(ALasFile, HasPositionsIntensitiesAndTimesOfItsPoints)
{
    LasPointWriter writer(path_);
    writer.append({{1.23449, -2.3456, 2'146'000.125}, 100, kTime + kSecond / 4});
    writer.append({{0, 0, 0}, 300, kTime + 1});
    writer.append({{0, 0, 0}, -3, 1'400'000'000 * kSecond});
    writer.close();
    const LasFile las(path_);
    EXPECT_DOUBLE_EQ(las.coordinate(0, 0), 1.234);
    EXPECT_DOUBLE_EQ(las.coordinate(0, 1), -2.346);
    EXPECT_DOUBLE_EQ(las.coordinate(0, 2), 2'146'000.125);
    EXPECT_EQ(las.intensity(0), 25700);
    EXPECT_EQ(las.intensity(1), 65535);
    EXPECT_EQ(las.intensity(2), 0);
    EXPECT_EQ(las.at<std::uint8_t>(las.row(0) + 14), 0x09);
    // 2023-11-14 22:13:20 UTC is second 1 384 035 218 of GPS: 18 leap seconds.
    EXPECT_DOUBLE_EQ(las.time(0), 384'035'218.25);
    // In 2014 there were 16.
    EXPECT_DOUBLE_EQ(las.time(2), 1'400'000'000.0 - 315'964'800 + 16 - 1e9);
}

TEST_F(ALasFile, OfAClockThatCountsFromItsStartHasTimesAsTheyAre)
{
    LasPointWriter writer(path_);
    writer.append({{0, 0, 0}, 0, 12 * kSecond + kSecond / 2});
    writer.close();
    const LasFile las(path_);
    EXPECT_EQ(las.at<std::uint16_t>(6), 0);
    EXPECT_EQ(las.time(0), 12.5);
}

TEST_F(ALasFile, IsWholeAfterEachFlush)
{
    LasPointWriter writer(path_);
    EXPECT_EQ(LasFile(path_).points(), 0U);
    EXPECT_EQ(LasFile(path_).bytes.size(), 227U);
    for (int i = 1; i <= 3; i++)
    {
        writer.append({{1.0 * i, 0, 0}, 0, kTime});
        writer.flush();
        const LasFile las(path_);
        EXPECT_EQ(las.points(), static_cast<std::size_t>(i));
        EXPECT_EQ(las.bytes.size(), 227U + 28U * static_cast<std::size_t>(i));
        EXPECT_DOUBLE_EQ(las.max(0), i);
        EXPECT_DOUBLE_EQ(las.min(0), 1);
    }
}

TEST_F(ALasFile, LeavesOutWhatItCannotHold)
{
    LasPointWriter writer(path_);
    EXPECT_FALSE(writer.append({{0, -2'148'000, 0}, 0, kTime}));
    EXPECT_FALSE(writer.append({{1e30, 0, 0}, 0, kTime}));
    EXPECT_TRUE(writer.append({{0, 0, 7}, 0, kTime}));
    EXPECT_THROW(
        writer.append({{std::numeric_limits<double>::quiet_NaN(), 0, 0}, 0, kTime}),
        std::runtime_error);
    writer.close();
    EXPECT_THROW(writer.append({{0, 0, 7}, 0, kTime}), std::runtime_error);
    const LasFile las(path_);
    EXPECT_EQ(las.points(), 1U);
    EXPECT_DOUBLE_EQ(las.min(2), 7);
    EXPECT_THROW(LasPointWriter(folder_ / "no/such.las"), std::runtime_error);
}

TEST_F(ALasFile, IsFilteredWithItsHeader)
{
    LasPointWriter writer(path_);
    for (int i = 0; i < 10; i++)
        writer.append({{1.0 * i, 0, 0}, static_cast<float>(i), kTime + i * kSecond});
    writer.close();
    LasPointWriter::filter(path_, [](std::size_t i) { return i == 3 || i == 8; });
    const LasFile las(path_);
    ASSERT_EQ(las.points(), 2U);
    EXPECT_EQ(las.bytes.size(), 227U + 2 * 28);
    EXPECT_EQ(las.at<std::uint16_t>(6), 1);
    EXPECT_DOUBLE_EQ(las.min(0), 3);
    EXPECT_DOUBLE_EQ(las.max(0), 8);
    EXPECT_EQ(las.intensity(1), 8 * 257);
    EXPECT_DOUBLE_EQ(las.time(1) - las.time(0), 5);
    EXPECT_FALSE(std::filesystem::exists(path_ + ".part"));
    std::filesystem::resize_file(path_, 240);
    EXPECT_THROW(
        LasPointWriter::filter(path_, [](std::size_t) { return true; }), std::runtime_error);
}
}  // namespace
}  // namespace taut::test
