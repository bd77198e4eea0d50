#include "Offscreen.h"

#include <GL/osmesa.h>
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace taut
{
namespace
{
/** MRPT calls gl functions by name: they must be those of OSMesa. Where another OpenGL library
 * comes first (one that the program links), they know nothing of the context and crash. */
void requireFunctionsOfOSMesa()
{
    void* const function = dlsym(RTLD_DEFAULT, "glGenVertexArrays");
    Dl_info info{};
    const bool found = function != nullptr && dladdr(function, &info) != 0;
    const std::string library = found ? info.dli_fname : "nowhere";
    if (library.find("OSMesa") == std::string::npos)
        throw std::runtime_error(
            "the OpenGL functions of this program come from " + library +
            ", not from libOSMesa: link libOSMesa directly and no other OpenGL library");
}

/** A camera at the origin that looks along z, y down: where the objects are drawn. */
mrpt::opengl::CCamera toMrpt(const ViewCamera& camera)
{
    mrpt::opengl::CCamera result;
    result.set6DOFMode(true);
    const auto [width, height] = camera.size;
    if (camera.orthographic)
    {
        // MRPT 2.5 shows half of the "zoom distance" along the shorter side of the picture.
        result.setOrthogonal(true);
        result.setZoomDistance(static_cast<float>(2 * std::min(width, height) / camera.scale));
    }
    else
    {
        mrpt::img::TCamera pinhole;
        pinhole.ncols = static_cast<uint32_t>(width);
        pinhole.nrows = static_cast<uint32_t>(height);
        pinhole.setIntrinsicParamsFromValues(camera.scale, camera.scale, width / 2.0, height / 2.0);
        result.setProjectiveFromPinhole(pinhole);
    }
    return result;
}

/** Depth [m] of a value of the depth buffer, 0 to 1; 0 for the far end, where nothing was drawn. */
float metresOf(float value, const ViewCamera& camera)
{
    if (value >= 1) return 0;
    const double near = camera.near_depth, far = camera.far_depth, v = static_cast<double>(value);
    return static_cast<float>(
        camera.orthographic ? near + v * (far - near) : near * far / (far - v * (far - near)));
}
}  // namespace

struct Offscreen::Context
{
    Context()
    {
        requireFunctionsOfOSMesa();
        constexpr std::array<int, 11> attributes{
            OSMESA_FORMAT,
            OSMESA_RGBA,
            OSMESA_DEPTH_BITS,
            24,
            OSMESA_PROFILE,
            OSMESA_CORE_PROFILE,
            OSMESA_CONTEXT_MAJOR_VERSION,
            3,
            OSMESA_CONTEXT_MINOR_VERSION,
            3,
            0};
        handle = OSMesaCreateContextAttribs(attributes.data(), nullptr);
        if (handle == nullptr)
            throw std::runtime_error("OSMesa cannot create an OpenGL 3.3 core context");
    }
    ~Context() { OSMesaDestroyContext(handle); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    void makeCurrent()
    {
        if (OSMesaMakeCurrent(handle, window.data(), GL_UNSIGNED_BYTE, kSide, kSide) != GL_TRUE)
            throw std::runtime_error("the OpenGL context of OSMesa cannot be made current");
    }

    static constexpr int kSide = 16;  // never drawn to: all drawing goes to a framebuffer object
    std::array<unsigned char, 4 * kSide * kSide> window{};
    OSMesaContext handle = nullptr;
};

Offscreen::Offscreen() : context_(std::make_unique<Context>()) {}

Offscreen::~Offscreen()
{
    context_->makeCurrent();
    framebuffer_.destroy();
}

void Offscreen::bindFramebuffer(PixelSize size)
{
    const auto width = static_cast<unsigned>(size.width);
    const auto height = static_cast<unsigned>(size.height);
    if (!framebuffer_.initialized() || framebuffer_.width() != width ||
        framebuffer_.height() != height)
    {
        framebuffer_.destroy();
        framebuffer_.create(width, height);
    }
    framebuffer_.bind();
}

Layer Offscreen::draw(mrpt::opengl::COpenGLScene& scene, const ViewCamera& camera)
{
    context_->makeCurrent();
    bindFramebuffer(camera.size);
    const auto viewport = scene.getViewport();
    viewport->setCustomBackgroundColor({1, 1, 1, 1});
    viewport->setViewportClipDistances(
        static_cast<float>(camera.near_depth), static_cast<float>(camera.far_depth));
    const mrpt::opengl::CCamera eye = toMrpt(camera);
    viewport->render(camera.size.width, camera.size.height, 0, 0, &eye);
    Layer layer = readBack(camera);
    framebuffer_.unbind();
    scene.freeOpenGLResources();
    return layer;
}

Layer Offscreen::readBack(const ViewCamera& camera)
{
    const auto [width, height] = camera.size;
    Layer layer{Picture(camera.size), {}};
    layer.depth.resize(layer.picture.pixels.size());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, layer.picture.pixels.data());
    glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, layer.depth.data());
    if (glGetError() != GL_NO_ERROR)
        throw std::runtime_error("OSMesa cannot give the picture back");
    for (float& depth : layer.depth) depth = metresOf(depth, camera);
    for (int y = 0; y < height / 2; ++y)  // OpenGL begins at the bottom
    {
        const auto top = static_cast<std::ptrdiff_t>(layer.picture.index(0, y));
        const auto end = top + width;  // a structured binding is captured from C++20 on
        const auto bottom = static_cast<std::ptrdiff_t>(layer.picture.index(0, height - 1 - y));
        const auto swapRows = [&](auto& values)
        { std::swap_ranges(values.begin() + top, values.begin() + end, values.begin() + bottom); };
        swapRows(layer.picture.pixels);
        swapRows(layer.depth);
    }
    return layer;
}
}  // namespace taut
