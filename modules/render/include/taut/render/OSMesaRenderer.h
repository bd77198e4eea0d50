#pragma once

#include <memory>

#include "taut/core/Renderer.h"

namespace taut
{
struct OSMesaRendererConfig
{
    int width = 1600, height = 1000;  //!< of the picture [pixels]
    int supersampling = 2;            //!< pixels drawn for one of the picture, along each axis
    int max_points = 400000;          //!< of the map that are drawn; more are thinned evenly
    bool cut_ceiling = true;          //!< leave out a ceiling that would hide the floor
};

/** Draws with MRPT's scenes on Mesa's software renderer, off screen: needs no display, no EGL and
 * no graphics card. On white; the map by height, with darker edges where the depth jumps; the
 * trajectory in red, paler where the map hides it; below the picture the caption, the scale and
 * the legend of heights.
 *
 * Not to be used from two threads at once. Same scene, same bytes. */
class OSMesaRenderer : public Renderer
{
    DEFINE_MRPT_OBJECT(OSMesaRenderer, taut)
 public:
    OSMesaRenderer();
    ~OSMesaRenderer() override;
    OSMesaRenderer(const OSMesaRenderer& other);
    OSMesaRenderer& operator=(const OSMesaRenderer& other);

    void configure(ConfigSection& section) override;
    void render(const RenderScene& scene, View view, const std::string& png_path) override;

    /** Throws ConfigError if such a picture cannot be drawn. */
    void setConfig(const OSMesaRendererConfig& config);
    const OSMesaRendererConfig& config() const { return config_; }

 private:
    class Studio;

    OSMesaRendererConfig config_;
    std::unique_ptr<Studio> studio_;  //!< made with the first picture
};

/** Makes the renderers of this module known to MRPT's class factory. */
void registerRenderers();
}  // namespace taut
