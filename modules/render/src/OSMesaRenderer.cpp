#include "taut/render/OSMesaRenderer.h"

#include <mrpt/img/CImage.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "Compose.h"
#include "Legend.h"
#include "Objects.h"
#include "Offscreen.h"
#include "taut/render/PointCloud.h"
#include "taut/render/ViewCamera.h"

IMPLEMENTS_MRPT_OBJECT(OSMesaRenderer, taut::Renderer, taut)

namespace taut
{
namespace
{
constexpr int kLargestSide = 16384;  // [pixels] of what Mesa draws at once
constexpr Rgb kPathColor{230, 0, 110}, kLoopColor{255, 200, 0}, kStartColor{255, 255, 255},
    kEndColor{60, 0, 30};
constexpr double kLabelHeight = 15;  // of the font [pixels]

void savePng(const Picture& picture, const std::string& path)
{
    mrpt::img::CImage image(
        static_cast<unsigned>(picture.size.width), static_cast<unsigned>(picture.size.height),
        mrpt::img::CH_RGB);
    for (int y = 0; y < picture.size.height; ++y)
    {
        auto* to = image.ptrLine<std::uint8_t>(static_cast<unsigned>(y));
        for (int x = 0; x < picture.size.width; ++x)
        {
            const auto [red, green, blue] = picture.pixels[picture.index(x, y)];
            for (const std::uint8_t channel : {blue, green, red}) *to++ = channel;
        }
    }
    if (!image.saveToFile(path))
        throw std::runtime_error("picture '" + path + "' cannot be written");
}

/** The points a picture is made of, before it is known which are in sight. */
PointCloud selectPoints(const RenderScene& scene, const OSMesaRendererConfig& config)
{
    const PointCloud points = finitePoints(scene.points);
    return config.cut_ceiling ? withoutCeiling(points, scene.trajectory) : points;
}

Span heightsOf(const PointCloud& points)
{
    std::vector<double> heights;
    heights.reserve(points.size());
    for (const auto& p : points) heights.push_back(static_cast<double>(p.z()));
    return robustSpan(heights, 0.02);
}

PointCloud inSight(const PointCloud& points, const ViewCamera& camera)
{
    PointCloud seen;
    std::copy_if(
        points.begin(), points.end(), std::back_inserter(seen),
        [&](const Eigen::Vector3f& p) { return camera.sees(p.cast<double>()); });
    return seen;
}

/** "start" to the lower left of the first pose and "end" to the upper right of the last one, so
 * that they do not collide where the path is closed; nothing for a pose that is out of sight. */
std::vector<Words> wordsAtEnds(
    const std::vector<Pose>& trajectory, const ViewCamera& camera, int supersampling)
{
    std::vector<Words> words;
    const auto add = [&](const Pose& pose, const char* text, double right, double down)
    {
        if (!camera.sees(pose.p)) return;
        const Vector3d pixel = camera.project(pose.p) / supersampling;
        Words w{text, 0, 0, kLabelHeight};
        w.x = pixel.x() + right - (right < 0 ? w.width() : 0);
        w.y = pixel.y() + down;
        words.push_back(w);
    };
    add(trajectory.front(), "start", -9, kLabelHeight + 5);
    add(trajectory.back(), "end", 9, -9);
    return words;
}

/** What a picture shows and how. */
struct Setting
{
    PointCloud outline;  //!< few points, without strays: the extent of the map
    PointCloud points;   //!< those to draw
    Span heights;        //!< that the colours span
    ViewCamera camera;
    Legend legend;
};

Setting arrange(const RenderScene& scene, View view, const OSMesaRendererConfig& config)
{
    constexpr int kOutlinePoints = 60000;
    const int n = config.supersampling;
    const PixelSize size{config.width, config.height};
    Setting s;
    const PointCloud points = selectPoints(scene, config);
    s.outline = withoutStrays(
        thinned(points, static_cast<std::size_t>(std::min(kOutlinePoints, config.max_points))));
    s.heights = heightsOf(points);
    s.legend.caption = scene.caption;
    s.legend.heights = s.heights;
    const int world_height = size.height - s.legend.height(size);
    s.camera = makeCamera(view, s.outline, scene.trajectory, {n * size.width, n * world_height});
    s.points = thinned(inSight(points, s.camera), static_cast<std::size_t>(config.max_points));
    const double metres_per_pixel = n * s.camera.metresPerPixel(s.camera.focus_depth);
    s.legend.grid_step = roundNumber(size.width / 8.0 * metres_per_pixel);
    if (s.camera.orthographic) s.legend.metres_per_pixel = metres_per_pixel;
    return s;
}
}  // namespace

/** Draws one picture after the other. */
class OSMesaRenderer::Studio
{
 public:
    Picture draw(const RenderScene& scene, View view, const OSMesaRendererConfig& config);

 private:
    Picture drawGround(const Setting& setting, const std::vector<Pose>& trajectory);
    Layer drawPoints(const Setting& setting, int supersampling);
    Layer drawPath(const RenderScene& scene, const ViewCamera& camera, int supersampling);

    Offscreen offscreen_;
};

Picture OSMesaRenderer::Studio::drawGround(
    const Setting& setting, const std::vector<Pose>& trajectory)
{
    const auto extent = [&](const Vector3d& axis)
    { return extentAlong(setting.outline, trajectory, axis); };
    const double z = setting.points.empty() ? extent(Vector3d::UnitZ()).low : setting.heights.low;
    mrpt::opengl::COpenGLScene scene;
    scene.insert(makeGrid(
        extent(Vector3d::UnitX()), extent(Vector3d::UnitY()), z, setting.legend.grid_step,
        setting.camera));
    return offscreen_.draw(scene, setting.camera).picture;
}

Layer OSMesaRenderer::Studio::drawPoints(const Setting& setting, int supersampling)
{
    const double dot = 2 * meanSpacing(setting.points);
    mrpt::opengl::COpenGLScene scene;
    for (const auto& cloud :
         makeClouds(setting.points, setting.heights, setting.camera, dot, supersampling))
        scene.insert(cloud);
    Layer layer = offscreen_.draw(scene, setting.camera);
    shadeByDepth(layer, setting.camera, supersampling, 2 * dot);
    return layer;
}

Layer OSMesaRenderer::Studio::drawPath(
    const RenderScene& drawn, const ViewCamera& camera, int supersampling)
{
    const std::vector<Pose>& trajectory = drawn.trajectory;
    const double pixel = supersampling * camera.metresPerPixel(camera.focus_depth);
    Solids solids(camera);
    solids.addPath(trajectory, 2.2 * pixel, kPathColor);
    for (const auto& [from, to] : drawn.loops)
    {
        solids.addTube(from, to, 1.5 * pixel, kLoopColor);
        solids.addSphere(from, 3.5 * pixel, kLoopColor);
        solids.addSphere(to, 3.5 * pixel, kLoopColor);
    }
    solids.addAxes(trajectory.front(), 45 * pixel, 2 * pixel);
    solids.addSphere(trajectory.front().p, 6 * pixel, kStartColor);
    solids.addSphere(trajectory.back().p, 6 * pixel, kEndColor);
    mrpt::opengl::COpenGLScene scene;
    auto& light = scene.getViewport()->lightParameters();
    light.ambient = {0.6F, 0.6F, 0.6F};
    light.diffuse = {0.6F, 0.6F, 0.6F};
    light.specular = {0, 0, 0};
    light.direction = {0.4F, 0.5F, 0.768F};  // from behind the camera, upper left
    scene.insert(solids.object());
    return offscreen_.draw(scene, camera);
}

Picture OSMesaRenderer::Studio::draw(
    const RenderScene& scene, View view, const OSMesaRendererConfig& config)
{
    const int n = config.supersampling;
    const Setting setting = arrange(scene, view, config);
    Picture world = drawGround(setting, scene.trajectory);
    const Layer points = drawPoints(setting, n);
    paintOver(world, points, points, 1);
    std::vector<Words> words;
    if (!scene.trajectory.empty())
    {
        const double opacity_if_hidden = setting.camera.orthographic ? 1 : 0.5;
        const Layer path = drawPath(scene, setting.camera, n);
        paintOver(world, path, points, opacity_if_hidden);
        words = wordsAtEnds(scene.trajectory, setting.camera, n);
    }
    Picture picture({config.width, config.height});
    const Picture small = averagedDown(world, n);
    std::copy(small.pixels.begin(), small.pixels.end(), picture.pixels.begin());
    for (Words& w : setting.legend.draw(picture)) words.push_back(std::move(w));
    printWords(picture, words, offscreen_, n);
    return picture;
}

OSMesaRenderer::OSMesaRenderer() = default;
OSMesaRenderer::~OSMesaRenderer() = default;
OSMesaRenderer::OSMesaRenderer(const OSMesaRenderer& other)
    : Renderer(other), config_(other.config_)
{
}
OSMesaRenderer& OSMesaRenderer::operator=(const OSMesaRenderer& other)
{
    config_ = other.config_;
    return *this;
}

void OSMesaRenderer::configure(ConfigSection& section)
{
    OSMesaRendererConfig c = config_;
    section.key("width", c.width, {200, kLargestSide}, "pixels of the picture");
    section.key("height", c.height, {150, kLargestSide}, "pixels of the picture");
    section.key("supersampling", c.supersampling, {1, 4}, "pixels drawn for one, along each axis");
    section.key("max_points", c.max_points, {1000, 100e6}, "points drawn; more are thinned evenly");
    section.key("cut_ceiling", c.cut_ceiling, "leave out a ceiling that would hide the floor");
    setConfig(c);
}

void OSMesaRenderer::setConfig(const OSMesaRendererConfig& config)
{
    const int side = config.supersampling * std::max(config.width, config.height);
    if (side > kLargestSide)
        throw ConfigError(
            "a picture of " + std::to_string(config.width) + " x " + std::to_string(config.height) +
            " pixels with supersampling " + std::to_string(config.supersampling) +
            " is too large: at most " + std::to_string(kLargestSide) + " pixels are drawn a side");
    config_ = config;
}

void OSMesaRenderer::render(const RenderScene& scene, View view, const std::string& png_path)
{
    requireDrawable(scene, view);
    if (!studio_) studio_ = std::make_unique<Studio>();
    savePng(studio_->draw(scene, view, config_), png_path);
}

void registerRenderers()
{
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(OSMesaRenderer, taut));
}
}  // namespace taut
