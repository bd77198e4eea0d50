#pragma once

#include <mrpt/opengl/COpenGLFramebuffer.h>
#include <mrpt/opengl/COpenGLScene.h>

#include <memory>

#include "Picture.h"

namespace taut
{
/** Draws MRPT scenes into memory, on one OpenGL context of OSMesa (no window system). MRPT's
 * CFBORender does the same, but its depths come from a table and are wrong by up to 3 %. */
class Offscreen
{
 public:
    /** Throws std::runtime_error if there is no usable context. */
    Offscreen();
    ~Offscreen();
    Offscreen(const Offscreen&) = delete;
    Offscreen& operator=(const Offscreen&) = delete;

    /** What the camera sees of the scene, and the scene's text messages, on white. Takes the
     * scene's OpenGL resources away again. */
    Layer draw(mrpt::opengl::COpenGLScene& scene, const ViewCamera& camera);

 private:
    struct Context;

    void bindFramebuffer(PixelSize size);
    static Layer readBack(const ViewCamera& camera);

    std::unique_ptr<Context> context_;
    mrpt::opengl::COpenGLFramebuffer framebuffer_;  // goes before the context
};
}  // namespace taut
