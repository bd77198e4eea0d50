#pragma once

#include <string>

#include "taut/core/Plugins.h"
#include "taut/core/Renderer.h"
#include "taut/core/WarningLog.h"

namespace taut
{
/** Draws all views of a scene as snapshot_*.png into a folder. False if that failed: the warning
 * `no_pictures` says why. */
bool drawViews(
    const Prototype<Renderer>& prototype, const RenderScene& scene, const std::string& folder,
    WarningLog& warnings);
}  // namespace taut
