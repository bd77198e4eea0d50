#include "taut/packets/ouster/SensorInfo.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace taut::ouster
{
namespace
{
using nlohmann::json;
constexpr double kDegree = M_PI / 180, kMillimetre = 1e-3;
constexpr double kMostTurns = 1000;  // [Hz] none turns faster

/** The value of a key: at the top, as old firmware has it, or in one of the sections of new. */
class Description
{
 public:
    explicit Description(const std::string& text) : root_(parsed(text))
    {
        if (!root_.is_object()) throw std::runtime_error("it is no JSON object");
    }

    const json* find(const std::string& key) const
    {
        if (const auto it = root_.find(key); it != root_.end()) return &*it;
        for (const char* section :
             {"data_format", "lidar_data_format", "beam_intrinsics", "lidar_intrinsics",
              "imu_intrinsics", "imu_data_format", "sensor_info", "config_params"})
        {
            const auto s = root_.find(section);
            if (s == root_.end() || !s->is_object()) continue;
            if (const auto it = s->find(key); it != s->end()) return &*it;
        }
        return nullptr;
    }

    template <class T>
    T get(const std::string& key, const T& otherwise) const
    {
        const json* value = find(key);
        return value ? as<T>(*value, key) : otherwise;
    }

    template <class T>
    T need(const std::string& key) const
    {
        const json* value = find(key);
        if (!value) throw std::runtime_error("it has no '" + key + "'");
        return as<T>(*value, key);
    }

 private:
    static json parsed(const std::string& text)
    {
        try
        {
            return json::parse(text);
        }
        catch (const json::exception& e)
        {
            throw std::runtime_error(e.what());
        }
    }

    template <class T>
    static T as(const json& value, const std::string& key)
    {
        if constexpr (std::is_integral_v<T>)
        {
            const double number = value.is_number() ? value.get<double>() : 0;
            if (!(number >= std::numeric_limits<T>::min() &&
                  number <= std::numeric_limits<T>::max()))
                throw std::runtime_error("its '" + key + "' is impossible");
        }
        try
        {
            return value.get<T>();
        }
        catch (const json::exception&)
        {
            throw std::runtime_error("its '" + key + "' is not of the right type");
        }
    }

    json root_;
};

/** "1024x10": columns and turns a second. */
void readMode(const Description& description, SensorInfo& info)
{
    int columns = 0;
    const auto mode = description.get<std::string>("lidar_mode", "");
    if (std::sscanf(mode.c_str(), "%dx%lf", &columns, &info.frame_rate) != 2 ||
        !(info.frame_rate > 0 && info.frame_rate <= kMostTurns))
        info.frame_rate = 0;
    info.columns_per_frame = description.get("columns_per_frame", columns);
    if (info.columns_per_frame < 1 || info.columns_per_frame > 8192)
        throw std::runtime_error("it tells neither 'columns_per_frame' nor a 'lidar_mode'");
}

Profile readProfile(const Description& description)
{
    static const std::map<std::string, Profile> known{
        {"LEGACY", Profile::Legacy},
        {"RNG19_RFL8_SIG16_NIR16", Profile::Rng19Rfl8Sig16Nir16},
        {"RNG19_RFL8_SIG16_NIR16_DUAL", Profile::Rng19Rfl8Sig16Nir16Dual},
        {"RNG15_RFL8_NIR8", Profile::Rng15Rfl8Nir8},
        {"RNG15_RFL8_NIR8_DUAL", Profile::Rng15Rfl8Nir8Dual},
        {"FUSA_RNG15_RFL8_NIR8_DUAL", Profile::FusaRng15Rfl8Nir8Dual}};
    const auto name = description.get<std::string>("udp_profile_lidar", "LEGACY");
    const auto it = known.find(name);
    if (it == known.end())
        throw std::runtime_error("its udp_profile_lidar '" + name + "' cannot be decoded here");
    return it->second;
}

/** A 4 x 4 matrix, row by row, with the translation in mm. */
Pose readTransform(const Description& description, const std::string& key, const Pose& otherwise)
{
    const auto m = description.get<std::vector<double>>(key, {});
    if (m.empty()) return otherwise;
    if (m.size() != 16) throw std::runtime_error("its '" + key + "' is no 4 x 4 matrix");
    Pose pose;
    for (int row = 0; row < 3; row++)
    {
        for (int column = 0; column < 3; column++) pose.R(row, column) = m[4 * row + column];
        pose.p[row] = m[4 * row + 3] * kMillimetre;
    }
    if ((pose.R * pose.R.transpose() - Matrix3d::Identity()).norm() > 1e-3)
        throw std::runtime_error("its '" + key + "' is no rigid transformation");
    pose.R = normalizedRotation(pose.R);
    return pose;
}

std::vector<double> readAngles(const Description& description, const std::string& key, int pixels)
{
    auto angles = description.need<std::vector<double>>(key);
    if (angles.size() != static_cast<std::size_t>(pixels))
        throw std::runtime_error(
            "its '" + key + "' has " + std::to_string(angles.size()) + " angles for " +
            std::to_string(pixels) + " pixels a column");
    for (double& angle : angles) angle *= kDegree;
    return angles;
}

/** [mm] What the maker's own programs take where old firmware does not tell it. */
double usualBeamOrigin(const std::string& model)
{
    for (const auto& [line, origin] :
         {std::pair("OS-0-", 27.67), std::pair("OS-1-", 15.806), std::pair("OS-2-", 13.762)})
        if (model.compare(0, 5, line) == 0) return origin;
    return 12.163;  // of the first generation, which was an OS1
}

Vector3d readBeamOrigin(const Description& description)
{
    const auto origin = readTransform(description, "beam_to_lidar_transform", {}).p;
    if (!origin.isZero()) return origin;
    const double usual = usualBeamOrigin(description.get<std::string>("prod_line", ""));
    return {description.get("lidar_origin_to_beam_origin_mm", usual) * kMillimetre, 0, 0};
}

/** A number, or a number as text. */
std::uint64_t readSerial(const Description& description)
{
    const json* value = description.find("prod_sn");
    if (!value) return 0;
    if (value->is_number_unsigned()) return value->get<std::uint64_t>();
    return value->is_string() ? std::strtoull(value->get<std::string>().c_str(), nullptr, 10) : 0;
}
}  // namespace

SensorInfo parseSensorInfo(const std::string& text)
{
    const Description description(text);
    SensorInfo info;
    info.model = description.get<std::string>("prod_line", "");
    info.serial = readSerial(description);
    info.profile = readProfile(description);
    info.legacy_imu = description.get<std::string>("udp_profile_imu", "LEGACY") == "LEGACY";
    readMode(description, info);
    info.columns_per_packet = description.get("columns_per_packet", 16);
    const auto altitudes = description.need<std::vector<double>>("beam_altitude_angles").size();
    info.pixels_per_column = description.get("pixels_per_column", static_cast<int>(altitudes));
    if (info.columns_per_packet < 1 || info.columns_per_packet > 1024 ||
        info.pixels_per_column < 1 || info.pixels_per_column > 1024)
        throw std::runtime_error("its 'columns_per_packet' or 'pixels_per_column' is impossible");
    info.beam_altitudes = readAngles(description, "beam_altitude_angles", info.pixels_per_column);
    info.beam_azimuths = readAngles(description, "beam_azimuth_angles", info.pixels_per_column);
    info.beam_origin = readBeamOrigin(description);
    // The data sheet's for an OS1, whose old firmware did not tell them.
    const Pose half_turn{expSO3({0, 0, M_PI}), {0, 0, 0.03618}};
    const Pose imu{Matrix3d::Identity(), {0.006253, -0.011775, 0.007645}};
    info.T_sensor_lidar = readTransform(description, "lidar_to_sensor_transform", half_turn);
    info.T_sensor_imu = readTransform(description, "imu_to_sensor_transform", imu);
    info.lidar_port = description.get<std::uint16_t>("udp_port_lidar", info.lidar_port);
    info.imu_port = description.get<std::uint16_t>("udp_port_imu", info.imu_port);
    return info;
}

SensorInfo loadSensorInfo(const std::string& path)
{
    std::ifstream file(path);
    std::ostringstream text;
    if (!file || !(text << file.rdbuf())) throw std::runtime_error("cannot read '" + path + "'");
    try
    {
        return parseSensorInfo(text.str());
    }
    catch (const std::exception& e)
    {
        throw std::runtime_error("'" + path + "' does not describe an Ouster: " + e.what());
    }
}
}  // namespace taut::ouster
