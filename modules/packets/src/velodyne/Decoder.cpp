#include "taut/packets/velodyne/Decoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "PacketLayout.h"

namespace taut::velodyne
{
namespace
{
constexpr double kDegree = M_PI / 180;
constexpr double kSmallestLeap = 3;     // [deg]
constexpr double kLongestLeap = 250e6;  // [ns]: a turn at 5 Hz and some more

std::string hex(unsigned value)
{
    char text[16];
    std::snprintf(text, sizeof text, "0x%02x", value);
    return text;
}

/** Corrections of the azimuth repeat after the last one; without any there are none. */
Calibration fromDegrees(
    std::initializer_list<double> elevations, const std::vector<double>& corrections = {0})
{
    Calibration calibration;
    for (const double e : elevations)
    {
        Laser laser;
        laser.elevation = e * kDegree;
        laser.azimuth_correction = corrections[calibration.size() % corrections.size()] * kDegree;
        calibration.push_back(laser);
    }
    return calibration;
}

bool isKnown(std::uint8_t model)
{
    const Model models[] = {Model::Hdl32, Model::Vlp16, Model::Vlp32, Model::Vls128};
    return std::find(std::begin(models), std::end(models), static_cast<Model>(model)) !=
           std::end(models);
}

int azimuthBetween(const std::uint8_t* packet, int from, int to)
{
    return (blockAzimuth(packet, to) - blockAzimuth(packet, from) + kFullTurn) % kFullTurn;
}

// The median step, since a head that fires only within a sector leaps between two blocks.
double turningRate(const std::uint8_t* packet, const PacketInfo& info, double otherwise)
{
    const FiringPattern& pattern = firingPattern(info.model);
    const int blocks_per_firing = blocksPerFiring(info);
    std::vector<int> steps;
    for (int block = blocks_per_firing; block < usedBlocks(info); block += blocks_per_firing)
        steps.push_back(azimuthBetween(packet, block - blocks_per_firing, block));
    if (steps.empty()) return otherwise;
    // Of two steps the shorter one: the other may be a leap.
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle * kAzimuthUnit / pattern.blockPeriod();  // [deg/ns]
}

/** When the firings of each block begin, since the packet's stamp [ns]. Firing goes on at its pace
 * but where the head leaps over a sector that it does not fire in. */
std::array<double, kBlocks> blockTimes(
    const std::uint8_t* packet, const PacketInfo& info, double rate)
{
    const int blocks_per_firing = blocksPerFiring(info);
    const double period = firingPattern(info.model).blockPeriod();
    std::array<double, kBlocks> times{};
    for (int block = blocks_per_firing; block < usedBlocks(info); block++)
    {
        double step = 0;
        if (block % blocks_per_firing == 0)
        {
            const double turned = azimuthBetween(packet, block - 1, block) * kAzimuthUnit;
            const double leap = turned - rate * period;
            step = period;
            if (leap > kSmallestLeap && leap < rate * kLongestLeap) step += leap / rate;
        }
        times[block] = times[block - 1] + step;
    }
    return times;
}

/** Of the lasers in a block: 0, or up to 3 for a model with more lasers than a block holds. */
int bankOf(const std::uint8_t* packet, int block, const FiringPattern& pattern)
{
    const auto flag = read16(packet + blockAt(block));
    for (int bank = 0; bank < pattern.blocks; bank++)
        if (flag == kBankFlags[bank]) return bank;
    throw std::runtime_error("a Velodyne block has the flag " + hex(flag) + " instead of 0xeeff");
}

void checkBlocks(const std::uint8_t* packet, const PacketInfo& info)
{
    for (int block = 0; block < usedBlocks(info); block++)
        bankOf(packet, block, firingPattern(info.model));
}

Eigen::Vector3f toPoint(const Laser& laser, double range, double azimuth)
{
    const double r = range + laser.range_correction;
    const double a = azimuth - laser.azimuth_correction;
    const double ce = std::cos(laser.elevation), se = std::sin(laser.elevation);
    const double horizontal = r * ce - laser.vertical_offset * se;
    const double left = laser.horizontal_offset;
    return Eigen::Vector3d(
               horizontal * std::cos(a) + left * std::sin(a),
               -horizontal * std::sin(a) + left * std::cos(a), r * se + laser.vertical_offset * ce)
        .cast<float>();
}

// In a pair of dual-return blocks the second one repeats the first where there was one return only.
bool repeatsFirstOfPair(const std::uint8_t* packet, int block, int slot)
{
    const auto* second = packet + returnAt(block, slot);
    const auto* first = packet + returnAt(block - 1, slot);
    return read16(first) == read16(second);
}
}  // namespace

const FiringPattern& firingPattern(Model model)
{
    static const FiringPattern vlp16{16, 2, 2304, 55296};
    static const FiringPattern hdl32{32, 1, 1152, 46080};
    static const FiringPattern vlp32{32, 1, 2304, 55296, 2, 1, 0, 0, 0.004};
    static const FiringPattern vls128{128, 1, 2665, 53300, 8, 4, 8, -8700, 0.004};
    switch (model)
    {
        case Model::Hdl32:
            return hdl32;
        case Model::Vlp32:
            return vlp32;
        case Model::Vls128:
            return vls128;
        case Model::Vlp16:
            break;
    }
    return vlp16;
}

double FiringPattern::laserTime(int laser) const
{
    const int group = laser / at_once;
    return (group + (pause_after > 0 ? group / pause_after : 0)) * laser_period;
}

const Calibration& defaultCalibration(Model model)
{
    static const Calibration vlp16 =
        fromDegrees({-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15});
    static const Calibration hdl32 = fromDegrees(
        {-30.67, -9.33,  -29.33, -8.00,  -28.00, -6.67,  -26.67, -5.33,  -25.33, -4.00,  -24.00,
         -2.67,  -22.67, -1.33,  -21.33, 0.00,   -20.00, 1.33,   -18.67, 2.67,   -17.33, 4.00,
         -16.00, 5.33,   -14.67, 6.67,   -13.33, 8.00,   -12.00, 9.33,   -10.67, 10.67});
    static const Calibration vlp32 = fromDegrees(
        {-25,    -1,     -1.667, -15.639, -11.31, 0,      -0.667, -8.843, -7.254, 0.333,  -0.333,
         -6.148, -5.333, 1.333,  0.667,   -4,     -4.667, 1.667,  1,      -3.667, -3.333, 3.333,
         2.333,  -2.667, -3,     7,       4.667,  -2.333, -2,     15,     10.333, -1.333},
        {-1.4, 4.2, -1.4, 1.4, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -4.2, 1.4,
         -1.4, 4.2, -1.4, 4.2, -4.2, 1.4, -1.4, 1.4, -1.4, 1.4, -1.4, 4.2, -4.2, 1.4, -1.4, 1.4});
    static const Calibration vls128 = fromDegrees(
        {-11.742, -1.99, 3.4,   -5.29,   -0.78, 4.61,   -4.08, 1.31,   -6.5,  -1.11,   4.28,
         -4.41,   0.1,   6.48,  -3.2,    2.19,  -3.86,  1.53,  -9.244, -1.77, 2.74,    -5.95,
         -0.56,   4.83,  -2.98, 2.41,    -6.28, -0.89,  3.62,  -5.07,  0.32,  7.58,    -0.34,
         5.18,    -3.64, 1.75,  -25,     -2.43, 2.96,   -5.73, 0.54,   9.7,   -2.76,   2.63,
         -7.65,   -1.55, 3.84,  -4.85,   3.18,  -5.51,  -0.12, 5.73,   -4.3,  1.09,    -16.042,
         -2.21,   4.06,  -4.63, 0.76,    15,    -3.42,  1.97,  -6.85,  -1.33, -5.62,   -0.23,
         5.43,    -3.53, 0.98,  -19.582, -2.32, 3.07,   -4.74, 0.65,   11.75, -2.65,   1.86,
         -7.15,   -1.44, 3.95,  -2.1,    3.29,  -5.4,   -0.01, 4.5,    -4.19, 1.2,     -13.565,
         -1.22,   4.17,  -4.52, 0.87,    6.08,  -3.31,  2.08,  -6.65,  1.42,  -10.346, -1.88,
         3.51,    -6.06, -0.67, 4.72,    -3.97, 2.3,    -6.39, -1,     4.39,  -5.18,   0.21,
         6.98,    -3.09, 4.98,  -3.75,   1.64,  -8.352, -2.54, 2.85,   -5.84, -0.45,   8.43,
         -2.87,   2.52,  -6.17, -1.66,   3.73,  -4.96,  0.43},
        {-6.354, -4.548, -2.732, -0.911, 0.911, 2.732, 4.548, 6.354});
    switch (model)
    {
        case Model::Hdl32:
            return hdl32;
        case Model::Vlp32:
            return vlp32;
        case Model::Vls128:
            return vls128;
        case Model::Vlp16:
            break;
    }
    return vlp16;
}

int blocksPerFiring(const PacketInfo& info)
{
    return firingPattern(info.model).blocks * (info.mode == ReturnMode::Dual ? 2 : 1);
}

int usedBlocks(const PacketInfo& info)
{
    const int blocks_per_firing = blocksPerFiring(info);
    return kBlocks / blocks_per_firing * blocks_per_firing;
}

Duration packetDuration(const PacketInfo& info)
{
    const int firings = kBlocks / blocksPerFiring(info);
    return std::llround(firings * firingPattern(info.model).blockPeriod());
}

std::uint16_t blockAzimuth(const std::uint8_t* packet, int block)
{
    return read16(packet + blockAt(block) + 2);
}

PacketInfo packetInfo(const std::uint8_t* packet)
{
    const auto model = packet[kModelAt];
    const auto mode = packet[kModeAt];
    if (!isKnown(model))
        throw std::runtime_error(
            "Velodyne model " + hex(model) +
            " is not known (0x21 HDL-32E, 0x22 VLP-16, 0x28 VLP-32C, 0xa1 VLS-128)");
    if (mode < static_cast<std::uint8_t>(ReturnMode::Strongest) ||
        mode > static_cast<std::uint8_t>(ReturnMode::Dual))
        throw std::runtime_error(
            "Velodyne return mode " + hex(mode) +
            " is not known (0x37 strongest, 0x38 last, 0x39 dual)");
    return {read32(packet + kTimeAt), static_cast<Model>(model), static_cast<ReturnMode>(mode)};
}

PacketInfo decodePacket(
    const std::uint8_t* packet, const Calibration& calibration, std::vector<Return>& returns,
    double turning_rate)
{
    const PacketInfo info = packetInfo(packet);
    const FiringPattern& pattern = firingPattern(info.model);
    if (calibration.size() != static_cast<std::size_t>(pattern.lasers))
        throw std::runtime_error(
            "the calibration has " + std::to_string(calibration.size()) + " lasers, the sensor " +
            std::to_string(pattern.lasers));
    checkBlocks(packet, info);

    const bool dual = info.mode == ReturnMode::Dual;
    const double rate = turningRate(packet, info, turning_rate);
    const auto times = blockTimes(packet, info, rate);
    const int lasers = std::min(pattern.lasers, kReturnsPerBlock);  // of a sequence, in a block
    for (int block = 0; block < usedBlocks(info); block++)
    {
        const int first_laser = bankOf(packet, block, pattern) * kReturnsPerBlock;
        const double block_azimuth = blockAzimuth(packet, block) * kAzimuthUnit;
        for (int slot = 0; slot < kReturnsPerBlock; slot++)
        {
            const auto* cell = packet + returnAt(block, slot);
            const auto range = read16(cell);
            if (range == 0 || (dual && block % 2 == 1 && repeatsFirstOfPair(packet, block, slot)))
                continue;
            const int laser = first_laser + slot % lasers;
            const double in_block =
                slot / lasers * pattern.sequence_period + pattern.laserTime(laser);
            const double azimuth = std::fmod(block_azimuth + rate * in_block, 360);
            Return r;
            r.position = toPoint(calibration[laser], range * pattern.range_unit, azimuth * kDegree);
            r.azimuth = static_cast<float>(azimuth);
            r.offset =
                static_cast<std::int32_t>(std::lround(pattern.first + times[block] + in_block));
            r.laser = static_cast<std::uint8_t>(laser);
            r.intensity = cell[2];
            r.block = static_cast<std::uint8_t>(block);
            returns.push_back(r);
        }
    }
    return info;
}

Duration PacketClock::sinceFirst(std::uint32_t microseconds)
{
    if (started_)
    {
        std::int64_t step = (static_cast<std::int64_t>(microseconds) - last_) % kHour;
        if (step < -kHour / 2) step += kHour;
        if (step > kHour / 2) step -= kHour;
        elapsed_ += step * 1000;
    }
    started_ = true;
    last_ = microseconds;
    return elapsed_;
}
}  // namespace taut::velodyne
