#pragma once

#include <optional>
#include <string>

#include "taut/core/Renderer.h"
#include "taut/odometry/OdometryConfig.h"
#include "taut/session/MapExport.h"
#include "taut/slam/SlamConfig.h"

namespace taut
{
/** All that a method file says: how to estimate, and what to write. A value. */
struct Method
{
    OdometryConfig odometry;
    SlamConfig slam;
    MapExportConfig map_export;
    Prototype<Renderer> renderer;
    bool refined = true;    //!< write poses and points as the next scan leaves them, one scan late
    std::string effective;  //!< YAML of everything as it took effect

    /** Reads all sections. A rig's noise of the IMU goes before the file's, and before what is seen
     * at rest; `effective` shows it. Throws ConfigError, also on a key that is unknown. */
    static Method read(ConfigSection& root, const std::optional<ImuNoise>& noise_of_rig);
};
}  // namespace taut
