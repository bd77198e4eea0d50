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

const ImportFormat* formatOf(const Recording& recording)
{
    for (const ImportFormat& format : importFormats())
        if (format.matches(recording)) return &format;
    return nullptr;
}

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

bool canBeImported(const std::string& path)
{
    std::error_code error;
    // A look at anything else (a pipe) would take from it.
    if (!fs::is_directory(path, error) && !fs::is_regular_file(path, error)) return false;
    try
    {
        return formatOf(look(path)) != nullptr;
    }
    catch (const std::runtime_error&)  // whoever reads it tells why
    {
        return false;
    }
}

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
    if (const ImportFormat* format = formatOf(recording))
    {
        const auto open = [&](const WarningSink& to)
        { return format->open(recording, options, to); };
        return std::make_unique<CheckedSource>(
            path, std::make_unique<CompletedSource>(open, options, warn), options, warn);
    }
    std::string known;
    for (const ImportFormat& format : importFormats())
        known += std::string(known.empty() ? "" : ", ") + format.name;
    throw std::runtime_error("'" + path + "' is no recording that can be imported: " + known);
}
}  // namespace taut
