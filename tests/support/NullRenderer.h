#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "taut/core/Renderer.h"

namespace taut::test
{
/** A renderer that draws nothing: keeps the contract, writes an empty file and remembers the calls.
 * One source of the test program says IMPLEMENTS_MRPT_OBJECT(NullRenderer, taut::Renderer,
 * taut::test).
 */
class NullRenderer : public Renderer
{
    DEFINE_MRPT_OBJECT(NullRenderer, taut::test)
 public:
    struct Call
    {
        View view;
        std::string path;
        std::size_t points, poses;
    };

    void configure(ConfigSection& /*section*/) override {}
    void render(const RenderScene& scene, View view, const std::string& png_path) override
    {
        requireDrawable(scene, view);
        if (!std::ofstream(png_path))
            throw std::runtime_error("picture '" + png_path + "' cannot be written");
        calls.push_back({view, png_path, scene.points.size(), scene.trajectory.size()});
    }

    std::vector<Call> calls;
};
}  // namespace taut::test
