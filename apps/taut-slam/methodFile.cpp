#include "methodFile.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "taut/ConfigFolders.h"
#include "taut/core/Config.h"

namespace fs = std::filesystem;

namespace taut
{
namespace
{
using Yaml = mrpt::containers::yaml;

struct Setting
{
    std::string section, key, value;  // of "section.key=value"; a section may have dots
};

Setting parse(const std::string& text)
{
    const auto equal = text.find('=');
    const auto dot = text.rfind('.', equal);
    if (equal == std::string::npos || dot == std::string::npos || dot == 0)
        throw ConfigError("'" + text + "' is not of the form SECTION.KEY=VALUE");
    return {text.substr(0, dot), text.substr(dot + 1, equal - dot - 1), text.substr(equal + 1)};
}

/** The section of that path, made where it is not there. */
Yaml::map_t& sectionAt(Yaml& root, const std::string& path)
{
    Yaml::map_t* section = &root.asMap();
    std::istringstream names(path);
    for (std::string name; std::getline(names, name, '.');)
    {
        Yaml::node_t& node = (*section)[name];
        if (node.isNullNode()) node.d.emplace<Yaml::map_t>();
        if (!node.isMap()) throw ConfigError("'" + path + "' is no section");
        section = &node.asMap();
    }
    return *section;
}

void apply(const Setting& setting, Yaml& root)
{
    Yaml::map_t& section = sectionAt(root, setting.section);
    const auto type = section.find("type");
    // The keys that the file gives for one class are unknown to another.
    if (setting.key == "type" && type != section.end() &&
        type->second.as<std::string>() != setting.value)
        section.clear();
    section[setting.key] = setting.value;
}
}  // namespace

std::string findMethodFile(const std::string& given)
{
    if (!given.empty())
    {
        if (!fs::exists(given)) throw ConfigError("no method file '" + given + "'");
        return given;
    }
    const fs::path program = fs::read_symlink("/proc/self/exe").parent_path();
    for (const fs::path& folder : {program / kInstalledConfigFolder, fs::path(kSourceConfigFolder)})
        if (fs::exists(folder / "default.yaml"))
            return fs::weakly_canonical(folder / "default.yaml").string();
    throw ConfigError("config/default.yaml is not found; name a method file with -c");
}

Yaml readMethodFile(const std::string& path, const std::vector<std::string>& settings)
{
    Yaml root;
    try
    {
        root = Yaml::FromFile(path);
    }
    catch (const std::exception& e)
    {
        throw ConfigError("method file '" + path + "' is no YAML: " + e.what());
    }
    if (root.isNullNode()) root = Yaml::Map();
    std::vector<Setting> all;
    for (const std::string& setting : settings) all.push_back(parse(setting));
    // Classes first: whatever else is set is meant for the class that is set.
    std::stable_partition(all.begin(), all.end(), [](const Setting& s) { return s.key == "type"; });
    for (const Setting& s : all) apply(s, root);
    return root;
}
}  // namespace taut
