#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Imu.h"

namespace taut::test
{
/** An Ouster, written from its manual: packets of given ranges, the JSON that describes it, and
 * where its points are. */
class OusterSimulator
{
 public:
    std::string profile = "LEGACY";
    int columns = 64, pixels = 16, rate = 10, columns_per_packet = 16;
    std::uint64_t serial = 122201000998;
    Time device_start = 5'000'000'000;  //!< of frame 0; counts from the sensor's start

    Duration columnPeriod() const { return 1'000'000'000 / rate / columns; }
    double altitude(int pixel) const { return (20.0 - 2.5 * pixel) * M_PI / 180; }
    double azimuth(int pixel) const { return (pixel % 4 - 1.5) * 2.8 * M_PI / 180; }
    static constexpr double kBeamOrigin = 0.015806;  //!< [m]

    /** [mm]; 0 for no return. */
    std::function<unsigned(int frame, int column, int pixel)> range_mm = [](int f, int c, int p)
    { return (c + p) % 7 == 0 ? 0U : 8U * (500U + static_cast<unsigned>(100 * f + 10 * c + p)); };

    /** In the lidar frame. */
    Vector3d point(int frame, int column, int pixel) const
    {
        const double encoder = 2 * M_PI * (1 - static_cast<double>(column) / columns);
        const double along = range_mm(frame, column, pixel) * 1e-3 - kBeamOrigin;
        const double a = encoder - azimuth(pixel), e = altitude(pixel);
        return {
            along * std::cos(a) * std::cos(e) + kBeamOrigin * std::cos(encoder),
            along * std::sin(a) * std::cos(e) + kBeamOrigin * std::sin(encoder),
            along * std::sin(e)};
    }

    Time columnTime(int frame, int column) const
    {
        return device_start + frame * Duration{1'000'000'000 / rate} + column * columnPeriod();
    }

    nlohmann::json description() const
    {
        nlohmann::json j;
        j["prod_line"] = "OS-1-16";
        j["prod_sn"] = std::to_string(serial);
        j["lidar_mode"] = std::to_string(columns) + "x" + std::to_string(rate);
        j["data_format"] = {
            {"columns_per_frame", columns},
            {"columns_per_packet", columns_per_packet},
            {"pixels_per_column", pixels},
            {"udp_profile_lidar", profile}};
        for (int i = 0; i < pixels; i++)
        {
            j["beam_altitude_angles"].push_back(altitude(i) * 180 / M_PI);
            j["beam_azimuth_angles"].push_back(azimuth(i) * 180 / M_PI);
        }
        j["lidar_origin_to_beam_origin_mm"] = kBeamOrigin * 1000;
        j["lidar_to_sensor_transform"] = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1};
        j["imu_to_sensor_transform"] = {1, 0, 0, 6.253, 0, 1, 0, -11.775,
                                        0, 0, 1, 7.645, 0, 0, 0, 1};
        j["udp_port_lidar"] = 7502;
        j["udp_port_imu"] = 7503;
        return j;
    }

    using Bytes = std::vector<std::uint8_t>;

    int packetsPerFrame() const { return columns / columns_per_packet; }

    Bytes packet(int frame, int index) const
    {
        const bool legacy = profile == "LEGACY";
        Bytes bytes;
        if (isFusa())
        {
            put<std::uint32_t>(bytes, 1);
            put<std::uint32_t>(bytes, frame);
            bytes.insert(bytes.end(), 3, 0);
            for (int i = 0; i < 5; i++) put<std::uint8_t>(bytes, serial >> (8 * i) & 255);
            bytes.resize(32);
        }
        else if (!legacy)
        {
            put<std::uint16_t>(bytes, 1);
            put<std::uint16_t>(bytes, frame);
            bytes.insert(bytes.end(), 3, 0);
            for (int i = 0; i < 5; i++) put<std::uint8_t>(bytes, serial >> (8 * i) & 255);
            bytes.resize(32);
        }
        for (int i = 0; i < columns_per_packet; i++)
            putColumn(bytes, frame, index * columns_per_packet + i);
        if (!legacy) bytes.resize(bytes.size() + 32);
        return bytes;
    }

    static Bytes imuPacket(const ImuSample& sample)
    {
        Bytes bytes;
        put<std::int64_t>(bytes, 1);
        put<std::int64_t>(bytes, sample.t);
        put<std::int64_t>(bytes, sample.t);
        for (int i = 0; i < 3; i++) put<float>(bytes, sample.accel[i] / 9.80665);
        for (int i = 0; i < 3; i++) put<float>(bytes, sample.gyro[i] * 180 / M_PI);
        return bytes;
    }

 private:
    bool isFusa() const { return profile == "FUSA_RNG15_RFL8_NIR8_DUAL"; }

    template <class To, class From>
    static void put(Bytes& bytes, From value)
    {
        const To number = static_cast<To>(value);
        const auto* begin = reinterpret_cast<const std::uint8_t*>(&number);
        bytes.insert(bytes.end(), begin, begin + sizeof number);
    }

    void putColumn(Bytes& bytes, int frame, int column) const
    {
        const bool legacy = profile == "LEGACY";
        put<std::uint64_t>(bytes, columnTime(frame, column));
        put<std::uint16_t>(bytes, column);
        put<std::uint16_t>(bytes, legacy ? frame : 1);
        if (legacy) put<std::uint32_t>(bytes, 90112 * column / columns);
        for (int pixel = 0; pixel < pixels; pixel++)
            putPixel(bytes, range_mm(frame, column, pixel), static_cast<unsigned>(100 + pixel));
        if (legacy) put<std::uint32_t>(bytes, 0xffffffffU);
    }

    /** Every bit that is no range nor reflectivity is set: a reader that takes it fails. */
    void putPixel(Bytes& bytes, unsigned mm, unsigned reflectivity) const
    {
        if (profile == "LEGACY")
        {
            put<std::uint32_t>(bytes, mm | 0xf0000000U);
            put<std::uint16_t>(bytes, reflectivity);
            bytes.insert(bytes.end(), 6, 0xff);
        }
        else if (profile == "RNG19_RFL8_SIG16_NIR16")
        {
            put<std::uint32_t>(bytes, mm | 0xfff80000U);
            put<std::uint8_t>(bytes, reflectivity);
            bytes.insert(bytes.end(), 7, 0xff);
        }
        else if (profile == "RNG19_RFL8_SIG16_NIR16_DUAL")
        {
            put<std::uint32_t>(bytes, mm | 0x00f80000U | reflectivity << 24);
            bytes.insert(bytes.end(), 12, 0xff);
        }
        else
        {
            put<std::uint16_t>(bytes, mm / 8 | 0x8000U);
            put<std::uint8_t>(bytes, reflectivity);
            bytes.push_back(0xff);
            if (profile != "RNG15_RFL8_NIR8") bytes.insert(bytes.end(), 4, 0xff);
        }
    }
};
}  // namespace taut::test
