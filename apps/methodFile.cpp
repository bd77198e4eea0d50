#include "methodFile.h"

#include <algorithm>
#include <filesystem>

#include "taut/ConfigFolders.h"
#include "taut/core/Config.h"

namespace fs = std::filesystem;

namespace taut
{
namespace
{
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

void apply(const Setting& setting, YamlNode& root)
{
    YamlNode& section = root.section(setting.section);
    const YamlNode* type = section.find("type");
    // The keys that the file gives for one class are unknown to another.
    if (setting.key == "type" && type != nullptr && type->scalar != setting.value)
        section.map.clear();
    section.set(setting.key, setting.value);
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

ConfigSection readMethodFile(const std::string& path, const std::vector<std::string>& settings)
{
    YamlNode root = readYamlFile(path);
    std::vector<Setting> all;
    for (const std::string& setting : settings) all.push_back(parse(setting));
    // Classes first: whatever else is set is meant for the class that is set.
    std::stable_partition(all.begin(), all.end(), [](const Setting& s) { return s.key == "type"; });
    for (const Setting& s : all)
    {
        try
        {
            apply(s, root);
        }
        catch (const ConfigError& e)
        {
            throw ConfigError("setting '" + s.section + "." + s.key + "': " + e.what());
        }
    }
    return ConfigSection(root, "", path);
}
}  // namespace taut
