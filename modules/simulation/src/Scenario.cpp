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
    section.key(
        "clearance", s.clearance, kNotNegative, "m, of the body from every surface at the least");
    section.rejectUnknown();
    if (s.motion.type == MotionPreset::Replay && s.world.moving > 0)
        throw ConfigError(
            "configuration key 'world.moving': a replayed motion has no route for others");
    return s;
}
}  // namespace taut::simulation
