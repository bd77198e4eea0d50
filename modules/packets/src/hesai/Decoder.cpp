#include "taut/packets/hesai/Decoder.h"

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "../littleEndian.h"
#include "PacketLayout.h"

namespace taut::hesai
{
namespace
{
constexpr double kDegree = M_PI / 180, kAzimuthUnit = 0.01, kMillimetre = 1e-3;
constexpr int kSeparation = 100;          // [mm]
constexpr std::size_t kHeaderBytes = 12;  // the longest
constexpr Time kSecond = 1'000'000'000;

/** What tells the models with a header apart. */
struct Signature
{
    Model model;
    std::uint8_t major, minor;  // of the protocol
    std::uint8_t lasers, blocks;
};

bool hasHeader(const std::uint8_t* packet)
{
    return packet[0] == 0xee && packet[1] == 0xff;
}

bool isPandar40P(const std::uint8_t* packet, std::size_t bytes)
{
    const PacketLayout layout = layoutOf(Model::Pandar40P);
    const std::size_t size = layout.blockAt(layout.blocks) + layout.tail;
    return packet[0] == 0xff && packet[1] == 0xee &&
           (bytes == size || bytes == size + layout.optional);
}

/** Days since 1970 of a date of the Gregorian calendar. */
std::int64_t daysOf(int year, int month, int day)
{
    // Years begin in March here: then leap days are their last.
    const int y = month > 2 ? year : year - 1, m = (month + 9) % 12;
    return 365LL * y + y / 4 - y / 100 + y / 400 + (153 * m + 2) / 5 + day - 1 - 719468;
}

/** Seconds since 1970: as a date, or counted (two zeros, four bytes, the highest first). */
Time secondsOf(const std::uint8_t* utc)
{
    if (utc[0] == 0 && utc[1] == 0)
        return static_cast<Time>(utc[2]) << 24 | utc[3] << 16 | utc[4] << 8 | utc[5];
    // Years count from 2000 or from 1900, by the model and its firmware.
    const int year = utc[0] + (utc[0] < 70 ? 2000 : 1900);
    if (utc[1] < 1 || utc[1] > 12 || utc[2] < 1 || utc[2] > 31 || utc[3] > 23 || utc[4] > 59 ||
        utc[5] > 60)
        throw std::runtime_error("the date of a Hesai packet is none");
    return daysOf(year, utc[1], utc[2]) * 86400 + utc[3] * 3600 + utc[4] * 60 + utc[5];
}

int returnsOf(std::uint8_t mode, Model model)
{
    if (mode == 0x33 || mode == 0x34 || mode == 0x37 || mode == 0x38) return 1;
    if ((mode >= 0x39 && mode <= 0x3c) || mode == 0x3e) return 2;
    if (mode == 0x3d && model == Model::Xt32M) return 3;
    throw std::runtime_error(
        "Hesai return mode " + std::to_string(mode) + " of a " + nameOf(model) + " is not known");
}

[[noreturn]] void refuse(const std::uint8_t* packet, std::size_t bytes)
{
    if (bytes >= kHeaderBytes && hasHeader(packet))
        throw std::runtime_error(
            "a Hesai packet of protocol " + std::to_string(packet[2]) + "." +
            std::to_string(packet[3]) + " with " + std::to_string(packet[6]) + " lasers and " +
            std::to_string(packet[7]) + " blocks cannot be decoded here");
    throw std::runtime_error(
        "a packet of " + std::to_string(bytes) + " bytes is of no known Hesai sensor");
}

/** True if a later return of the same firing is the same for all that the sensor can tell. */
bool isRepeated(
    const std::uint8_t* packet, const PacketLayout& layout, int block, int after, int laser,
    double unit)
{
    const int range = readLittle<std::uint16_t>(packet + layout.unitAt(block, laser));
    for (int other = block + 1; other < after; other++)
    {
        const int o = readLittle<std::uint16_t>(packet + layout.unitAt(other, laser));
        if (o != 0 && std::abs(o - range) * unit < kSeparation) return true;
    }
    return false;
}

/** What the range counts [mm]. */
double rangeUnit(const std::uint8_t* packet, Model model)
{
    if (model == Model::Pandar40P) return 4;
    const double unit = packet[model == Model::Pandar64 ? 5 : 9];
    if (unit == 0) throw std::runtime_error("a Hesai packet counts ranges in 0 mm");
    return unit;
}

void checkFlags(const std::uint8_t* packet, Model model)
{
    if (model != Model::Pandar40P) return;
    const PacketLayout layout = layoutOf(model);
    for (int block = 0; block < layout.blocks; block++)
        if (const auto* b = packet + layout.blockAt(block); b[0] != 0xff || b[1] != 0xee)
            throw std::runtime_error("a block of a Pandar40P has not its flag 0xffee");
}
}  // namespace

std::optional<Model> modelOf(const std::uint8_t* packet, std::size_t bytes)
{
    static constexpr Signature kSignatures[] = {
        {Model::Qt64, 3, 1, 64, 4},
        {Model::Qt128, 3, 2, 128, 2},
        {Model::Xt16, 6, 1, 16, 8},
        {Model::Xt32, 6, 1, 32, 8},
        {Model::Xt32M, 6, 1, 32, 6}};
    if (bytes < kHeaderBytes) return {};
    if (isPandar40P(packet, bytes)) return Model::Pandar40P;
    if (!hasHeader(packet)) return {};
    if (packet[2] == 64 && packet[3] == 6) return Model::Pandar64;
    for (const Signature& s : kSignatures)
        if (packet[2] == s.major && packet[3] == s.minor && packet[6] == s.lasers &&
            packet[7] == s.blocks)
            return s.model;
    return {};
}

PacketInfo packetInfo(const std::uint8_t* packet, std::size_t bytes)
{
    const auto model = modelOf(packet, bytes);
    if (!model) refuse(packet, bytes);
    const PacketLayout layout = layoutOf(*model);
    const std::size_t tail_at = tailAt(packet, *model), end = tail_at + layout.tail;
    // A number of the packet, a checksum and a signature may follow.
    if (bytes < end || bytes > end + layout.optional || (bytes - end) % 4 != 0)
        throw std::runtime_error(
            "a packet of a " + nameOf(*model) + " has " + std::to_string(bytes) +
            " bytes instead of " + std::to_string(end + layout.optional));
    const std::uint8_t* tail = packet + tail_at;
    PacketInfo info;
    info.model = *model;
    info.returns = returnsOf(tail[layout.mode_at], *model);
    info.t = secondsOf(tail + layout.utc_at) * kSecond +
             static_cast<Time>(readLittle<std::uint32_t>(tail + layout.us_at)) * 1000;
    info.first_loop = *model != Model::Qt128 || (tail[5] & 1) != 0;
    return info;
}

PacketInfo decodePacket(
    const std::uint8_t* packet, std::size_t bytes, const Calibration& calibration,
    std::vector<Return>& returns)
{
    const PacketInfo info = packetInfo(packet, bytes);
    const PacketLayout layout = layoutOf(info.model);
    if (calibration.size() != static_cast<std::size_t>(layout.lasers))
        throw std::runtime_error(
            "the calibration has " + std::to_string(calibration.size()) + " lasers, the sensor " +
            std::to_string(layout.lasers));
    checkFlags(packet, info.model);
    const double unit = rangeUnit(packet, info.model);
    for (int block = 0; block < layout.blocks; block++)
    {
        const int first_of_firing = block - block % info.returns;
        const double head =
            blockAzimuth(packet, info.model, first_of_firing) * kAzimuthUnit * kDegree;
        for (int laser = 0; laser < layout.lasers; laser++)
        {
            const std::uint8_t* cell = packet + layout.unitAt(block, laser);
            const auto range = readLittle<std::uint16_t>(cell);
            const int after = first_of_firing + info.returns;
            if (range == 0 || isRepeated(packet, layout, block, after, laser, unit)) continue;
            const double r = range * unit * kMillimetre;
            if (r < shortestRange(info.model)) continue;
            const double a = head + calibration[laser].azimuth, e = calibration[laser].elevation;
            Return point;
            point.position =
                Eigen::Vector3d(
                    r * std::cos(e) * std::sin(a), r * std::cos(e) * std::cos(a), r * std::sin(e))
                    .cast<float>();
            point.offset = static_cast<std::int32_t>(std::lround(firingTime(info, block, laser)));
            point.laser = static_cast<std::uint8_t>(laser);
            point.reflectivity = cell[2];
            point.block = static_cast<std::uint8_t>(block);
            returns.push_back(point);
        }
    }
    return info;
}

std::uint16_t blockAzimuth(const std::uint8_t* packet, Model model, int block)
{
    const PacketLayout layout = layoutOf(model);
    return readLittle<std::uint16_t>(packet + layout.blockAt(block) + layout.block_header - 2);
}

double shortestRange(Model model)
{
    switch (model)
    {
        case Model::Pandar40P:
        case Model::Pandar64:
            return 0.3;
        case Model::Qt64:
            return 0.1;
        case Model::Xt32M:
            return 0.5;
        case Model::Qt128:
        case Model::Xt16:
        case Model::Xt32:
            break;
    }
    return 0.05;
}

int blocksOf(Model model)
{
    return layoutOf(model).blocks;
}

int lasersOf(Model model)
{
    return layoutOf(model).lasers;
}

std::string nameOf(Model model)
{
    static constexpr const char* kNames[] = {"Pandar40P",   "Pandar64", "PandarQT", "QT128",
                                             "PandarXT-16", "PandarXT", "XT32M"};
    return kNames[static_cast<std::size_t>(model)];
}
}  // namespace taut::hesai
