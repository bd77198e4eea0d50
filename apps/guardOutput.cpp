#include "guardOutput.h"

#include <filesystem>

#include "CommandLine.h"
#include "taut/files/sameFile.h"

namespace fs = std::filesystem;

namespace taut
{
void guardOutput(
    const std::string& output, const std::vector<std::string>& inputs,
    const std::function<bool(const std::string&)>& is_own)
{
    for (const std::string& written : {output, output + ".part"})
        if (const auto input = sameFile(written, inputs))
            throw UsageError(
                "'" + written + "' would overwrite '" + *input +
                "', which is read: choose another output");
    if (!fs::exists(output)) return;
    if (!fs::is_regular_file(output))
        throw UsageError("'" + output + "' is not a file that could be replaced");
    if (!is_own(output))
        throw UsageError(
            "'" + output + "' is there already, and not a file of taut's: choose another output");
}
}  // namespace taut
