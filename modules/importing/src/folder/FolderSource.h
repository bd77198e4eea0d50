#pragma once

#include "../ImportFormat.h"

namespace taut
{
/** A folder with clouds in it or in a folder "scans" of it, and imu.csv. */
bool isPlainFolder(const Recording& recording);

std::unique_ptr<ImportSource> openPlainFolder(
    const Recording& recording, const ImportOptions& options, const WarningSink& warn);
}  // namespace taut
