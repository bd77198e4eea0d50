#pragma once

#include <optional>

#include "support.h"
#include "taut/importing/openImportSource.h"

namespace taut::fuzz
{
/** Reads a recording to its end, and holds what comes out against what ImportSource promises. */
inline void importAll(const std::string& path, const ImportOptions& options = {})
{
    const auto source = openImportSource(path, options, [](const Warning&) {});
    std::optional<Time> last_sample, last_scan;
    const auto requireLater = [](Time t, std::optional<Time>& last)
    {
        require(!last || t > *last, "items of a sensor are in the order of time");
        last = t;
    };
    while (const auto item = source->next())
    {
        if (const auto* sample = std::get_if<ImuSample>(&*item))
        {
            require(sample->gyro.allFinite() && sample->accel.allFinite(), "readings are finite");
            requireLater(sample->t, last_sample);
        }
        else if (const auto* scan = std::get_if<Scan>(&*item))
        {
            for (const LidarPoint& point : scan->points)
                require(point.position.allFinite(), "points are finite");
            requireLater(scan->stamp, last_scan);
        }
        else
            requireLater(std::get<PacketScan>(*item).stamp, last_scan);
        const double progress = source->progress();
        require(progress >= 0 && progress <= 1, "progress is a share");
    }
    source->findings();
}

/** The same, for a recording of one file. */
inline bool importFile(const char* name, const Input& content, const ImportOptions& options = {})
{
    static const Folder folder;
    const std::string path = folder.write(name, content);
    return readOrRefuse([&] { importAll(path, options); });
}
}  // namespace taut::fuzz
