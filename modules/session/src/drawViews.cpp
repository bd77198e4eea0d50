#include "drawViews.h"

#include <filesystem>

namespace taut
{
bool drawViews(
    const Prototype<Renderer>& prototype, const RenderScene& scene, const std::string& folder,
    WarningLog& warnings)
{
    try
    {
        const std::unique_ptr<Renderer> renderer = prototype.create();
        for (const View view : kAllViews)
            renderer->render(
                scene, view,
                (std::filesystem::path(folder) / ("snapshot_" + std::string(nameOf(view)) + ".png"))
                    .string());
        return true;
    }
    catch (const std::exception& e)
    {
        warnings.add({0, "no_pictures", e.what()});
        return false;
    }
}
}  // namespace taut
