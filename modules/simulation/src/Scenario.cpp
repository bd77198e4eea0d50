#include "taut/simulation/Scenario.h"

#include <fstream>
#include <iterator>

namespace taut::simulation
{
namespace
{
using mrpt::containers::yaml;

void put(yaml& root, const std::string& setting)
{
    const auto equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
        throw ConfigError("setting '" + setting + "' is not of the form key=value");
    std::string name = setting.substr(0, equals);
    // Nest the value in its sections, as YAML text, and merge it from the top down.
    yaml::node_t* node = &root.node();
    for (std::size_t dot = name.find('.');; dot = name.find('.'))
    {
        if (node->isNullNode()) node->d.emplace<yaml::map_t>();
        if (!node->isMap())
            throw ConfigError("setting '" + setting + "': a part of its key is not a section");
        yaml::node_t key;
        key.d.emplace<yaml::scalar_t>(name.substr(0, dot));
        node = &node->asMap()[key];
        if (dot == std::string::npos) break;
        name = name.substr(dot + 1);
    }
    node->d.emplace<yaml::scalar_t>(setting.substr(equals + 1));
}
}  // namespace

ConfigSection loadScenarioFile(const std::string& path, const std::vector<std::string>& settings)
{
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read the scenario '" + path + "'");
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    yaml root = yaml::FromText(text);
    for (const auto& setting : settings) put(root, setting);
    return ConfigSection(root);
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
