#include "taut/importing/openImportSource.h"

#include <fstream>
#include <memory>
#include <stdexcept>
#include <utility>

#include "CheckedSource.h"
#include "CompletedSource.h"
#include "ImportFormat.h"

namespace taut
{
namespace fs = std::filesystem;

namespace
{
constexpr std::size_t kHeadBytes = 64;

Recording look(const std::string& path)
{
    Recording recording;
    recording.path = path;
    std::error_code error;
    recording.is_folder = fs::is_directory(path, error);
    if (recording.is_folder) return recording;
    if (!fs::exists(path, error)) throw std::runtime_error("'" + path + "' is not there");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read '" + path + "'");
    recording.head.resize(kHeadBytes);
    file.read(recording.head.data(), static_cast<std::streamsize>(kHeadBytes));
    recording.head.resize(static_cast<std::size_t>(file.gcount()));
    if (recording.head.empty()) throw std::runtime_error("'" + path + "' is empty");
    return recording;
}
}  // namespace

std::unique_ptr<ImportSource> openImportSource(
    const std::string& path, const ImportOptions& options, const WarningSink& sink)
{
    const Recording recording = look(path);
    // That clocks differ may show in more than one way.
    const WarningSink warn = [sink, told = std::make_shared<bool>(false)](const Warning& w)
    {
        const bool again = w.kind == "clock_offset" && std::exchange(*told, true);
        if (sink && !again) sink(w);
    };
    std::string known;
    for (const ImportFormat& format : importFormats())
    {
        if (format.matches(recording))
        {
            const auto open = [&](const WarningSink& sink)
            { return format.open(recording, options, sink); };
            return std::make_unique<CheckedSource>(
                path, std::make_unique<CompletedSource>(open, options, warn), options, warn);
        }
        known += std::string(known.empty() ? "" : ", ") + format.name;
    }
    throw std::runtime_error("'" + path + "' is no recording that can be imported: " + known);
}
}  // namespace taut
