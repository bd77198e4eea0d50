#include "methodFile.h"

#include <filesystem>

#include "taut/ConfigFolders.h"
#include "taut/core/Config.h"

namespace fs = std::filesystem;

namespace taut
{
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

mrpt::containers::yaml readMethodFile(
    const std::string& path, const std::vector<std::string>& settings)
{
    mrpt::containers::yaml root;
    try
    {
        root = mrpt::containers::yaml::FromFile(path);
    }
    catch (const std::exception& e)
    {
        throw ConfigError("method file '" + path + "' is no YAML: " + e.what());
    }
    if (root.isNullNode()) root = mrpt::containers::yaml::Map();
    for (const std::string& setting : settings)
    {
        const auto equal = setting.find('='), dot = setting.find('.');
        if (equal == std::string::npos || dot == std::string::npos || dot > equal)
            throw ConfigError("'" + setting + "' is not of the form SECTION.KEY=VALUE");
        const std::string section = setting.substr(0, dot);
        if (!root.has(section)) root[section] = mrpt::containers::yaml::Map();
        if (!root[section].isMap()) throw ConfigError("'" + section + "' is no section");
        root[section].asMap()[setting.substr(dot + 1, equal - dot - 1)] = setting.substr(equal + 1);
    }
    return root;
}
}  // namespace taut
