#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "taut/core/Warning.h"
#include "taut/importing/ImportOptions.h"
#include "taut/importing/ImportSource.h"

namespace taut
{
/** A recording before it is known what it is. */
struct Recording
{
    std::filesystem::path path;
    bool is_folder = false;
    std::string head;  //!< the first bytes of a file, at most 64
};

/** One format: how it is known, and how it is opened. */
struct ImportFormat
{
    const char* name;  //!< for messages
    bool (*matches)(const Recording& recording);
    std::unique_ptr<ImportSource> (*open)(
        const Recording& recording, const ImportOptions& options, const WarningSink& warn);
};

/** For the summary of a recording with an IMU that does not tell the pose of its LiDAR. */
inline constexpr const char* kPoseNotTold =
    "T_imu_lidar: not told, so the LiDAR is taken to be where the IMU is, with its axes (a rig "
    "file tells it)";

/** Every format, the most specific first. */
const std::vector<ImportFormat>& importFormats();
}  // namespace taut
