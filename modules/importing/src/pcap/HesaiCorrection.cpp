#include "HesaiCorrection.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

namespace taut
{
namespace fs = std::filesystem;

namespace
{
constexpr std::size_t kMostFiles = 100;

HesaiAngles load(const fs::path& path, hesai::Model model)
{
    const hesai::Calibration calibration = hesai::loadCorrection(path.string());
    try
    {
        hesai::checkCorrection(calibration, model);
    }
    catch (const hesai::CorrectionError& e)
    {
        throw hesai::CorrectionError("'" + path.string() + "': " + e.what());
    }
    return {calibration, path.string()};
}

/** The tables in a folder that are correction files of some Hesai, in the order of their names. */
std::vector<fs::path> correctionsIn(const fs::path& folder)
{
    std::vector<fs::path> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (entry.path().extension() == ".csv" && files.size() < kMostFiles)
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    const auto is_none = [](const fs::path& file)
    {
        try
        {
            hesai::loadCorrection(file.string());
            return false;
        }
        catch (const hesai::CorrectionError&)
        {
            return true;
        }
    };
    files.erase(std::remove_if(files.begin(), files.end(), is_none), files.end());
    return files;
}

/** The one that fits; nothing if there is none at all. */
std::optional<HesaiAngles> findIn(const fs::path& folder, hesai::Model model)
{
    std::optional<HesaiAngles> found;
    std::string misfit;
    for (const fs::path& file : correctionsIn(folder))
    {
        try
        {
            HesaiAngles angles = load(file, model);
            if (found)
                throw std::runtime_error(
                    "'" + found->path + "' and '" + angles.path +
                    "' both fit: --hesai-csv chooses");
            found = std::move(angles);
        }
        catch (const hesai::CorrectionError& e)
        {
            if (misfit.empty()) misfit = e.what();
        }
        catch (const std::runtime_error& e)
        {
            throw hesai::CorrectionError(e.what());
        }
    }
    if (!found && !misfit.empty())
        throw hesai::CorrectionError(misfit + " (--hesai-csv chooses another one)");
    return found;
}
}  // namespace

HesaiAngles findHesaiAngles(
    const std::string& recording, const std::string& given, hesai::Model model)
{
    if (!given.empty()) return load(given, model);
    fs::path path = recording;
    if (!path.empty() && !path.has_filename()) path = path.parent_path();
    std::error_code error;
    const bool is_folder = fs::is_directory(path, error);
    fs::path beside = path;
    if (is_folder)
        beside += ".csv";
    else
        beside.replace_extension(".csv");
    if (recording.empty()) return {hesai::defaultCalibration(model), ""};
    if (fs::exists(beside, error)) return load(beside, model);
    const fs::path folder = is_folder ? path : fs::absolute(path).parent_path();
    if (auto found = findIn(folder, model)) return *found;
    return {hesai::defaultCalibration(model), ""};
}
}  // namespace taut
