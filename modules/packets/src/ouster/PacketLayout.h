#pragma once

#include <cstddef>
#include <cstdint>

#include "taut/packets/ouster/SensorInfo.h"

/** \file PacketLayout.h
 * Where the fields of a lidar packet are; all numbers little-endian. A packet is a header, columns
 * (header, pixels, footer each) and a footer. */
namespace taut::ouster
{
struct PacketLayout
{
    std::size_t header, footer;                // bytes of the packet
    std::size_t column_header, column_footer;  // bytes of a column
    std::size_t pixel;                         // bytes
    std::uint32_t range_mask;                  // of the first four bytes of a pixel
    double range_unit;                         // [m]
    std::size_t reflectivity_at;               // in the pixel
    bool wide_reflectivity;                    // 16 bits instead of 8
    std::size_t frame_at, serial_at;           // in the packet; the frame's number has 16 bits

    std::size_t columnBytes(int pixels) const
    {
        return column_header + static_cast<std::size_t>(pixels) * pixel + column_footer;
    }
};

inline constexpr std::size_t kColumnTimeAt = 0, kMeasurementAt = 8;  // in a column, all profiles
inline constexpr std::size_t kStatusAt = 10;                         // in a column, not legacy

constexpr PacketLayout layoutOf(Profile profile)
{
    switch (profile)
    {
        case Profile::Legacy:
            return {0, 0, 16, 4, 12, 0xfffff, 0.001, 4, true, 10, 0};
        case Profile::Rng19Rfl8Sig16Nir16:
            return {32, 32, 12, 0, 12, 0x7ffff, 0.001, 4, false, 2, 7};
        case Profile::Rng19Rfl8Sig16Nir16Dual:
            return {32, 32, 12, 0, 16, 0x7ffff, 0.001, 3, false, 2, 7};
        case Profile::Rng15Rfl8Nir8Dual:
            return {32, 32, 12, 0, 8, 0x7fff, 0.008, 2, false, 2, 7};
        case Profile::FusaRng15Rfl8Nir8Dual:
            return {32, 32, 12, 0, 8, 0x7fff, 0.008, 2, false, 4, 11};
        case Profile::Rng15Rfl8Nir8:
            break;
    }
    return {32, 32, 12, 0, 4, 0x7fff, 0.008, 2, false, 2, 7};
}
}  // namespace taut::ouster
