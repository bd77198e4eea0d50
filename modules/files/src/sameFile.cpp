#include "taut/files/sameFile.h"

#include <filesystem>

namespace fs = std::filesystem;

namespace taut
{
std::optional<std::string> sameFile(const std::string& path, const std::vector<std::string>& files)
{
    if (!fs::exists(path)) return {};
    for (const std::string& file : files)
        if (!file.empty() && fs::exists(file) && fs::equivalent(file, path)) return file;
    return {};
}
}  // namespace taut
