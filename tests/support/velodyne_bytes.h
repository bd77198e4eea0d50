#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace taut::test
{
/** A return and where it is by the manual of the VLP-16 (63-9243), worked out by hand: distances
 * count 2 mm and azimuths 0.01 deg clockwise from above; a laser fires 2.304 us after the one
 * before it, a sequence 55.296 us after the one before it, and the head turns on in between. */
struct KnownReturn
{
    int block, laser, offset;  //!< [ns] since the packet's first firing
    double azimuth, x, y, z;   //!< [deg], [m]; x ahead (azimuth 0), y to the left, z up
    int intensity;
};

inline const std::vector<KnownReturn> kKnownReturns{
    // 10 m, 15 deg down, at 90 deg: 10 cos(15 deg) to the right.
    {0, 0, 0, 90, 0, -9.659258, -2.588190, 100},
    // 8 m, 1 deg up, 2.304 us on: 0.4 deg a block of 110.592 us makes 0.00833 deg.
    {0, 1, 2304, 90.008333, -0.001163, -7.998781, 0.139619, 0},
    // 50 m, 15 deg up, in the second sequence of block 2 at 90.8 deg: 89.856 us make 0.325 deg.
    {2, 15, 311040, 91.125, -0.948233, -48.286982, 12.940952, 255}};

/** A data packet of a VLP-16 with those returns and no others, byte by byte; no code of taut's has
 * a part in it. Its time is 13 min 21 s after the full hour. */
inline std::array<std::uint8_t, 1206> knownPacket()
{
    std::array<std::uint8_t, 1206> bytes{};
    for (std::size_t block = 0; block < 12; block++)
    {
        const std::size_t azimuth = 9000 + 40 * block;
        bytes[100 * block] = 0xff;
        bytes[100 * block + 1] = 0xee;
        bytes[100 * block + 2] = static_cast<std::uint8_t>(azimuth % 256);
        bytes[100 * block + 3] = static_cast<std::uint8_t>(azimuth / 256);
    }
    const auto put = [&bytes](std::size_t at, const std::vector<std::uint8_t>& values)
    {
        for (const std::uint8_t value : values) bytes[at++] = value;
    };
    put(4, {0x88, 0x13, 100});                        // 5000 x 2 mm
    put(7, {0xa0, 0x0f, 0});                          // 4000 x 2 mm
    put(200 + 4 + 3 * (16 + 15), {0xa8, 0x61, 255});  // 25000 x 2 mm
    put(1200, {0x40, 0x4a, 0xbe, 0x2f});              // 801 000 000 us
    put(1204, {0x37, 0x22});                          // strongest return, VLP-16
    return bytes;
}
}  // namespace taut::test
