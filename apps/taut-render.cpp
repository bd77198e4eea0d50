/** taut-render: draws pictures of the map and the trajectory that taut-slam left.
 * Exit codes: 0 done, 1 failed, 2 bad usage. */
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <optional>

#include "CommandLine.h"
#include "taut/files/PlyFile.h"
#include "taut/render/Caption.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace
{
struct Options
{
    std::filesystem::path input, output;
    std::vector<taut::View> views;
    taut::OSMesaRendererConfig renderer;
    std::optional<std::string> caption;
};

std::vector<taut::View> viewsOf(const std::string& name)
{
    if (name == "all") return {taut::kAllViews.begin(), taut::kAllViews.end()};
    for (const taut::View view : taut::kAllViews)
        if (name == nameOf(view)) return {view};
    throw taut::UsageError("unknown view '" + name + "'; choose from: top oblique follow all");
}

/** "1600x1000" */
void parseSize(const std::string& text, taut::OSMesaRendererConfig& config)
{
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, config.width);
    const bool by = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    if (by)
    {
        const auto height = std::from_chars(width.ptr + 1, end, config.height);
        if (height.ec == std::errc() && height.ptr == end) return;
    }
    throw taut::UsageError("size '" + text + "' is not like 1600x1000");
}

/** The limits of the renderer's configuration hold here too. */
void checkSize(const taut::OSMesaRendererConfig& config)
{
    taut::YamlNode keys;
    keys.section("").set("width", std::to_string(config.width));
    keys.set("height", std::to_string(config.height));
    taut::ConfigSection section(keys, "size");
    try
    {
        taut::OSMesaRenderer().configure(section);
    }
    catch (const taut::ConfigError& e)
    {
        throw taut::UsageError(e.what());
    }
}

/** Nothing if only help was asked for. */
std::optional<Options> parse(int argc, char** argv)
{
    TCLAP::CmdLine cmd(
        "taut-render: draws the map and the trajectory that taut-slam left. Exit codes: 0 done, "
        "1 failed, 2 bad usage.",
        ' ', TAUT_VERSION);
    TCLAP::ValueArg<std::string> input(
        "i", "input", "Folder with map.ply and trajectory.tum", true, "", "FOLDER", cmd);
    TCLAP::ValueArg<std::string> output(
        "o", "output", "Folder for snapshot_*.png (default: the input)", false, "", "FOLDER", cmd);
    TCLAP::ValueArg<std::string> view(
        "", "view", "What is drawn (default all)", false, "all", "top|oblique|follow|all", cmd);
    TCLAP::ValueArg<std::string> size(
        "", "size", "Pixels of a picture (default 1600x1000)", false, "1600x1000", "WxH", cmd);
    TCLAP::ValueArg<std::string> caption(
        "", "caption", "Text below the picture (default: folder, length, duration)", false, "",
        "TEXT", cmd);
    const taut::Usage usage{
        {"-i out/hall_fast", "-i out/hall_fast -o pictures --view top --size 800x600"}};
    if (!taut::parseCommandLine(cmd, argc, argv, usage)) return {};

    Options options;
    options.input = input.getValue();
    options.output = output.isSet() ? output.getValue() : input.getValue();
    options.views = viewsOf(view.getValue());
    parseSize(size.getValue(), options.renderer);
    checkSize(options.renderer);
    if (caption.isSet()) options.caption = caption.getValue();
    return options;
}

taut::RenderScene readScene(const Options& options)
{
    const auto warn = [](const taut::Warning& w) { std::cerr << "warning: " << w.text << "\n"; };
    taut::RenderScene scene;
    const auto points = taut::readPlyPoints((options.input / "map.ply").string());
    scene.points.reserve(points.size());
    for (const auto& point : points) scene.points.push_back(point.position);
    const auto bad = std::count_if(
        scene.points.begin(), scene.points.end(),
        [](const Eigen::Vector3f& p) { return !p.allFinite(); });
    if (bad > 0) std::cerr << "warning: " << bad << " points of the map are not finite: left out\n";

    const auto path = (options.input / "trajectory.tum").string();
    const taut::Trajectory trajectory = taut::readTum(path, warn);
    for (const auto& pose : trajectory) scene.trajectory.push_back(pose.T_world_imu);
    if (options.caption)
    {
        scene.caption = {*options.caption};
    }
    else if (!trajectory.empty())
    {
        const auto folder = std::filesystem::weakly_canonical(options.input).filename().string();
        scene.caption = taut::captionOf(
            {folder, taut::pathLength(trajectory), trajectory.back().t - trajectory.front().t, ""});
    }
    return scene;
}

void run(const Options& options)
{
    const taut::RenderScene scene = readScene(options);
    std::filesystem::create_directories(options.output);
    taut::OSMesaRenderer renderer;
    renderer.setConfig(options.renderer);
    for (const taut::View view : options.views)
    {
        const std::string name = "snapshot_" + std::string(nameOf(view)) + ".png";
        const std::string path = (options.output / name).string();
        renderer.render(scene, view, path);
        std::cout << path << "\n";
    }
}
}  // namespace

int main(int argc, char** argv)
{
    return taut::runProgram(
        "taut-render",
        [&]
        {
            if (const auto options = parse(argc, argv)) run(*options);
        });
}
