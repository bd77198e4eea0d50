/** Packets of a VLP-32C and a VLS-128, written byte by byte from their manuals. */
#include <gtest/gtest.h>

#include <cmath>

#include "taut/packets/velodyne/FrameAssembler.h"

namespace taut::test
{
namespace
{
using namespace velodyne;
using Bytes = std::array<std::uint8_t, kPacketBytes>;

constexpr double kDegree = M_PI / 180;
constexpr std::uint8_t kDual = 0x39, kStrongest = 0x37;

void put16(Bytes& packet, std::size_t at, int value)
{
    packet[at] = static_cast<std::uint8_t>(value % 256);
    packet[at + 1] = static_cast<std::uint8_t>(value / 256);
}

void setBlock(Bytes& packet, std::size_t block, int flag, int azimuth)
{
    put16(packet, 100 * block, flag);
    put16(packet, 100 * block + 2, azimuth);
}

void setReturn(Bytes& packet, std::size_t block, std::size_t slot, int range)
{
    put16(packet, 100 * block + 4 + 3 * slot, range);
    packet[100 * block + 6 + 3 * slot] = 77;
}

/** Without a return; `azimuth` [0.01 deg] of the first block, `step` from firing to firing. */
Bytes emptyPacket(Model model, std::uint8_t mode, int azimuth, int step)
{
    constexpr int kFlags[] = {0xeeff, 0xddff, 0xccff, 0xbbff};
    Bytes packet{};
    const int banks = model == Model::Vls128 ? 4 : 1, returns = mode == kDual ? 2 : 1;
    for (int block = 0; block < 12 / (banks * returns) * banks * returns; block++)
        setBlock(
            packet, static_cast<std::size_t>(block), kFlags[block / returns % banks],
            (azimuth + block / (banks * returns) * step) % 36000);
    packet[1204] = mode;
    packet[1205] = static_cast<std::uint8_t>(model);
    return packet;
}

std::vector<Return> decode(const Bytes& packet, double rate = 0)
{
    std::vector<Return> returns;
    const Model model = packetInfo(packet.data()).model;
    decodePacket(packet.data(), defaultCalibration(model), returns, rate);
    return returns;
}

/** Angles in degrees. */
void expectAt(const Return& r, double range, double azimuth, double elevation)
{
    const double a = azimuth * kDegree, e = elevation * kDegree;
    const Vector3d expected(
        range * std::cos(e) * std::cos(a), -range * std::cos(e) * std::sin(a), range * std::sin(e));
    EXPECT_LT((r.position.cast<double>() - expected).norm(), 1e-3);
}
}  // namespace

TEST(AVlp32, FiresPairsAndCountsFourMillimetres)
{
    Bytes packet = emptyPacket(Model::Vlp32, kStrongest, 14000, 20);
    setReturn(packet, 2, 3, 5000);
    const auto returns = decode(packet);
    ASSERT_EQ(returns.size(), 1U);
    EXPECT_EQ(returns[0].laser, 3);
    EXPECT_EQ(returns[0].intensity, 77);
    EXPECT_EQ(returns[0].offset, 2 * 55296 + 2304);
    // The head turns by 0.2 deg in 55.296 us; the laser looks 1.4 deg to the side.
    expectAt(returns[0], 20, 140.4 + 0.2 * 2304 / 55296 - 1.4, -15.639);
}

TEST(AVls128, FiresGroupsOfEightThatFillFourBlocks)
{
    Bytes packet = emptyPacket(Model::Vls128, kStrongest, 9000, 19);
    setReturn(packet, 7, 5, 2500);
    setReturn(packet, 8, 0, 2500);
    const auto returns = decode(packet);
    ASSERT_EQ(returns.size(), 2U);
    EXPECT_EQ(returns[0].laser, 101);
    // The 13th group of the second sequence, after the pause.
    EXPECT_EQ(returns[0].offset, 53300 + 13 * 2665 - 8700);
    expectAt(returns[0], 10, 90.19 + 0.19 * 13 * 2665 / 53300 - 2.732, -0.67);
    EXPECT_EQ(returns[1].laser, 0);
    EXPECT_EQ(returns[1].offset, 2 * 53300 - 8700);
    expectAt(returns[1], 10, 90.38 + 6.354, -11.742);
}

TEST(AVls128, OfDualReturnFillsEightBlocksWithOneSequence)
{
    Bytes packet = emptyPacket(Model::Vls128, kDual, 9000, 19);
    setReturn(packet, 6, 5, 2500);
    setReturn(packet, 7, 5, 2500);  // the same once more
    setReturn(packet, 0, 8, 2500);
    setReturn(packet, 1, 8, 2600);
    const auto returns = decode(packet, 3600e-9);
    ASSERT_EQ(returns.size(), 3U);
    EXPECT_EQ(returns[0].laser, 8);
    EXPECT_EQ(returns[1].laser, 8);
    EXPECT_EQ(returns[1].offset, 2665 - 8700);
    EXPECT_EQ(returns[2].laser, 101);
    expectAt(returns[2], 10, 90 + 3600e-9 * 13 * 2665 - 2.732, -0.67);
}

TEST(AVls128, WithAFlagOfNoBankIsRefused)
{
    Bytes packet = emptyPacket(Model::Vls128, kStrongest, 0, 19);
    put16(packet, 300, 0xaaff);
    EXPECT_THROW(decode(packet), std::runtime_error);
}

TEST(AVelodyne, GetsTheTimeThatTheHeadTakesOverASectorLeftOut)
{
    Bytes packet = emptyPacket(Model::Vlp32, kStrongest, 8800, 20);
    for (std::size_t block = 8; block < 12; block++)
        setBlock(packet, block, 0xeeff, 27000 + 20 * static_cast<int>(block - 8));
    for (std::size_t block = 0; block < 12; block++) setReturn(packet, block, 0, 1000);
    const auto returns = decode(packet);
    ASSERT_EQ(returns.size(), 12U);
    EXPECT_EQ(returns[7].offset, 7 * 55296);
    const double leap = (270 - 89.4) / 0.2 * 55296;
    EXPECT_NEAR(returns[8].offset, 7 * 55296 + leap, 10);
    EXPECT_NEAR(returns[9].offset - returns[8].offset, 55296, 1);
}

TEST(AVelodyne, OfAnotherModelInBetweenIsRefused)
{
    FrameAssembler frames(Model::Vlp32, defaultCalibration(Model::Vlp32));
    std::vector<Scan> complete;
    frames.add(emptyPacket(Model::Vlp32, kStrongest, 0, 20).data(), complete);
    EXPECT_THROW(
        frames.add(emptyPacket(Model::Vls128, kStrongest, 0, 19).data(), complete),
        std::runtime_error);
}
}  // namespace taut::test
