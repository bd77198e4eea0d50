#include "taut/simulation/Scenario.h"

namespace taut::simulation
{
namespace
{
void put(YamlNode& root, const std::string& setting)
{
    const auto equal = setting.find('=');
    if (equal == std::string::npos || equal == 0)
        throw ConfigError("setting '" + setting + "' is not of the form key=value");
    const auto dot = setting.rfind('.', equal);
    const bool nested = dot != std::string::npos;
    const std::size_t begin = nested ? dot + 1 : 0;
    try
    {
        root.section(nested ? setting.substr(0, dot) : "")
            .set(setting.substr(begin, equal - begin), setting.substr(equal + 1));
    }
    catch (const ConfigError& e)
    {
        throw ConfigError("setting '" + setting + "': " + e.what());
    }
}

/** A fault that cannot show in the rest of the scenario is a mistake. */
void checkTogether(const Scenario& s)
{
    const auto check = [](bool good, const std::string& key, const std::string& why)
    {
        if (!good) throw ConfigError("configuration key '" + key + "': " + why);
    };
    const bool has_route = s.motion.type != MotionPreset::Replay;
    check(
        has_route || s.world.moving == 0, "world.moving",
        "a replayed motion has no route for others");
    check(
        has_route || s.world.companions.ahead + s.world.companions.beside == 0, "world.companions",
        "a replayed motion has no route for others");
    check(
        s.imu.warming == 0 || s.imu.gyro_temperature > 0 || s.imu.accel_temperature > 0,
        "imu.warming",
        "no bias of this IMU depends on the temperature: give imu.gyro_temperature or "
        "imu.accel_temperature");
    check(
        s.lidar.incidence_error == 0 || s.lidar.divergence > 0, "lidar.incidence_error",
        "a beam without width (lidar.divergence) has no such error");
    check(
        extinction(s.weather) == 0 || s.lidar.detection_range > 0, "weather",
        "rain and dust take light, but all shots return whatever their light "
        "(lidar.detection_range: 0)");
    const PacketLoss& loss = s.lidar.packet_loss;
    check(
        loss.share <= loss.burst / (1 + loss.burst), "lidar.packet_loss.share",
        "so many are lost only if bursts are longer (lidar.packet_loss.burst)");
    const SoftMount& mount = s.lidar.soft_mount;
    check(
        mount.frequency > 0 || (mount.angle == 0 && mount.displacement == 0),
        "lidar.soft_mount.frequency", "a mount that vibrates needs one");
    check(
        s.lidar.min_range < s.lidar.max_range, "lidar.min_range",
        "nothing is between it and lidar.max_range");
}
}  // namespace

ConfigSection loadScenarioFile(const std::string& path, const std::vector<std::string>& settings)
{
    YamlNode root = readYamlFile(path);
    for (const std::string& setting : settings) put(root, setting);
    return ConfigSection(root, "", path);
}

Scenario readScenario(ConfigSection& section)
{
    Scenario s;
    section.key("duration", s.duration, {0.5, 36000}, "s, with the rest");
    section.key("rest", s.rest, {0, 3600}, "s, at the start; 0 = in motion at once");
    section.key("seed", s.seed, {0, 1e9}, "of motion and noise");
    section.key("start_time", s.start_time, kNotNegative, "s since the UNIX epoch");
    declare(section.section("world"), s.world);
    declare(section.section("motion"), s.motion);
    declare(section.section("lidar"), s.lidar);
    declare(section.section("imu"), s.imu);
    declare(section.section("faults"), s.faults);
    declare(section.section("weather"), s.weather);
    section.key(
        "clearance", s.clearance, kNotNegative, "m, of the body from every surface at the least");
    section.rejectUnknown();
    checkTogether(s);
    return s;
}
}  // namespace taut::simulation
