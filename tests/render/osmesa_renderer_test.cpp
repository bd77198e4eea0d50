#include "taut/render/OSMesaRenderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>

#include <fstream>
#include <functional>
#include <limits>

#include "structures.h"
#include "taut/render/HeightColors.h"
#include "taut/render/ViewCamera.h"
#include "temporary_folder.h"

using namespace taut;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

namespace
{
using ColorTest = std::function<bool(const Rgb&)>;

/** The picture in a file. */
class Image
{
 public:
    explicit Image(const std::string& path) { EXPECT_TRUE(image_.loadFromFile(path)) << path; }

    int width() const { return static_cast<int>(image_.getWidth()); }
    int height() const { return static_cast<int>(image_.getHeight()); }
    Rgb at(int x, int y) const
    {
        const auto* bgr =
            image_.ptr<std::uint8_t>(static_cast<unsigned>(x), static_cast<unsigned>(y));
        return {bgr[2], bgr[1], bgr[0]};
    }

    /** Where the pixels are that pass the test, in the part above the legend. */
    struct Found
    {
        int count = 0;
        Eigen::Vector2d mean = Eigen::Vector2d::Zero();
        Eigen::Array2d low{1e9, 1e9}, high{-1e9, -1e9};
    };
    Found find(const ColorTest& test) const
    {
        Found found;
        for (int y = 0; y < 0.85 * height(); ++y)
            for (int x = 0; x < width(); ++x)
            {
                if (!test(at(x, y))) continue;
                ++found.count;
                found.mean += Eigen::Vector2d(x + 0.5, y + 0.5);
                found.low = found.low.min(Eigen::Array2d(x, y));
                found.high = found.high.max(Eigen::Array2d(x + 1, y + 1));
            }
        if (found.count > 0) found.mean /= found.count;
        return found;
    }

 private:
    mrpt::img::CImage image_;
};

bool near(const Rgb& a, const Rgb& b)
{
    int distance = 0;
    for (std::size_t i = 0; i < 3; ++i) distance += std::abs(int{a[i]} - int{b[i]});
    return distance < 30;
}
ColorTest like(const Rgb& color)
{
    return [color](const Rgb& c) { return near(c, color); };
}
bool white(const Rgb& c)
{
    return near(c, {255, 255, 255});
}
bool ofPath(const Rgb& c)
{
    return c[0] > 120 && c[1] < 60 && c[2] > 40 && c[2] < 160;
}

class OSMesaPicture : public ::testing::Test
{
 protected:
    OSMesaPicture() { resize(640, 400); }

    void resize(int width, int height)
    {
        OSMesaRendererConfig config;
        config.width = width;
        config.height = height;
        renderer_.setConfig(config);
    }
    Image draw(const RenderScene& scene, View view)
    {
        renderer_.render(scene, view, path_);
        return Image(path_);
    }
    std::string bytes(const RenderScene& scene, View view)
    {
        renderer_.render(scene, view, path_);
        std::ifstream in(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    test::TemporaryFolder folder_;
    std::string path_ = folder_ / "picture.png";
    OSMesaRenderer renderer_;
};

/** Even ground of 40 m x 20 m at height 0 with a small plate, 10 m up, over (10, 5). */
RenderScene groundWithPlate()
{
    RenderScene scene;
    for (int i = 0; i <= 400; ++i)
        for (int j = 0; j <= 200; ++j)
            scene.points.emplace_back(
                0.1F * static_cast<float>(i) - 20, 0.1F * static_cast<float>(j) - 10, 0.F);
    for (int i = 0; i <= 100; ++i)
        for (int j = 0; j <= 100; ++j)
            scene.points.emplace_back(
                0.01F * static_cast<float>(i) + 9.5F, 0.01F * static_cast<float>(j) + 4.5F, 10.F);
    return scene;
}
}  // namespace

TEST_F(OSMesaPicture, HasTheSizeAskedForAndShowsMapAndTrajectoryInAllViews)
{
    const RenderScene scene = test::hall();
    for (const View view : kAllViews)
    {
        SCOPED_TRACE(nameOf(view));
        const Image image = draw(scene, view);
        EXPECT_EQ(image.width(), 640);
        EXPECT_EQ(image.height(), 400);
        const int background = image.find(white).count;
        EXPECT_GT(background, 640 * 400 / 20);
        EXPECT_LT(background, 640 * 400 * 2 / 3);
        EXPECT_GT(image.find(ofPath).count, 300);
        EXPECT_GT(image.find(like(heightColor(0))).count, 5000);  // the floor
    }
}

TEST_F(OSMesaPicture, PutsThePointsWhereTheyBelongInTheTopView)
{
    // Judged by the ground's outline: nothing of the renderer's own arithmetic is used.
    for (const bool tall : {false, true})
    {
        SCOPED_TRACE(tall);
        resize(tall ? 300 : 640, tall ? 640 : 400);
        RenderScene scene = groundWithPlate();
        const Image image = draw(scene, View::Top);
        const auto plate = image.find(like(heightColor(1)));
        const auto ground = image.find([](const Rgb& c) { return c[2] < 210 && c[0] > c[2] + 30; });
        ASSERT_GT(plate.count, 5);
        // x to the right and y up; in the tall picture x up and y to the left
        const Eigen::Array2d expected =
            tall ? Eigen::Array2d(0.25, 0.25) : Eigen::Array2d(0.75, 0.25);
        const Eigen::Array2d place = (plate.mean.array() - ground.low) / (ground.high - ground.low);
        EXPECT_NEAR(place.x(), expected.x(), 0.01);
        EXPECT_NEAR(place.y(), expected.y(), 0.01);
        const Eigen::Array2d share =
            (ground.high - ground.low) / Eigen::Array2d(image.width(), image.height());
        EXPECT_NEAR(share.maxCoeff(), 0.9, 0.02);
    }
}

TEST_F(OSMesaPicture, AgreesWithTheCameraInPerspective)
{
    for (const PixelSize size : {PixelSize{640, 400}, PixelSize{300, 640}})
    {
        resize(size.width, size.height);
        RenderScene scene = groundWithPlate();
        const Image image = draw(scene, View::Oblique);
        const auto plate = image.find(like(heightColor(1)));
        ASSERT_GT(plate.count, 5);
        // The legend takes the lowest part of the picture: the camera's picture ends where the
        // first row of the legend begins, so that only its middle is uncertain.
        const ViewCamera camera = makeCamera(View::Oblique, scene.points, {}, size);
        const Vector3d expected = camera.project({10, 5, 10});
        EXPECT_NEAR(plate.mean.x(), expected.x(), 0.04 * size.width);
        EXPECT_NEAR(plate.mean.y(), expected.y(), 0.12 * size.height);
    }
}

TEST_F(OSMesaPicture, IsTheSameByteForByteWheneverItIsDrawn)
{
    const RenderScene scene = test::hall(30);  // more points than are drawn
    OSMesaRendererConfig config = renderer_.config();
    config.max_points = 20000;
    renderer_.setConfig(config);
    for (const View view : kAllViews)
    {
        const std::string first = bytes(scene, view);
        bytes(test::street(), View::Follow);
        EXPECT_EQ(bytes(scene, view), first);
        OSMesaRenderer other(renderer_);
        other.render(scene, view, path_);
        std::ifstream in(path_, std::ios::binary);
        EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), first);
    }
}

TEST_F(OSMesaPicture, ACeilingDoesNotHideTheFloorUnlessAskedFor)
{
    const RenderScene scene = test::hall();
    const auto floor = like(heightColor(0));
    EXPECT_GT(draw(scene, View::Top).find(floor).count, 30000);
    OSMesaRendererConfig config = renderer_.config();
    config.cut_ceiling = false;
    renderer_.setConfig(config);
    EXPECT_LT(draw(scene, View::Top).find(floor).count, 15000);
}

TEST_F(OSMesaPicture, PointsThatAreNotFiniteAndStraysChangeNothing)
{
    RenderScene scene = test::hall();
    const std::string before = bytes(scene, View::Oblique);
    scene.points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.F, 0.F);
    EXPECT_EQ(bytes(scene, View::Oblique), before);
    scene.points.emplace_back(500.F, 500.F, 50.F);
    draw(scene, View::Top);
    const auto floor = Image(path_).find(like(heightColor(0)));
    EXPECT_GT(floor.count, 30000);  // the frame has not grown
}

TEST_F(OSMesaPicture, ATrajectoryOrAMapAloneIsEnough)
{
    RenderScene scene = test::hall();
    scene.points.clear();
    for (const View view : kAllViews) EXPECT_GT(draw(scene, view).find(ofPath).count, 300);
    scene = test::hall();
    scene.trajectory.clear();
    for (const View view : {View::Top, View::Oblique})
        EXPECT_LT(draw(scene, view).find(white).count, 640 * 400 * 2 / 3);
    scene = {};
    scene.points.assign(1, {1, 2, 3});
    EXPECT_GT(draw(scene, View::Top).find([](const Rgb& c) { return !white(c); }).count, 10);
}

TEST_F(OSMesaPicture, ExtentsOfMetresAndOfKilometresAreBothDrawn)
{
    for (const float scale : {0.1F, 50.F})
    {
        RenderScene scene = test::hall();
        for (auto& p : scene.points) p *= scale;
        for (auto& pose : scene.trajectory) pose.p *= static_cast<double>(scale);
        for (const View view : kAllViews)
            EXPECT_GT(draw(scene, view).find(ofPath).count, 150) << scale << nameOf(view);
    }
}

TEST_F(OSMesaPicture, FarFromTheOriginThePathIsAsSharpAsNearIt)
{
    const RenderScene near = test::street();
    RenderScene far = near;
    const Vector3d offset(5000, -3000, 100);
    for (auto& p : far.points) p += offset.cast<float>();
    for (auto& pose : far.trajectory) pose.p += offset;
    const auto here = draw(near, View::Follow).find(ofPath);
    const auto there = draw(far, View::Follow).find(ofPath);
    EXPECT_GT(here.count, 300);
    EXPECT_NEAR(here.count, there.count, 0.02 * here.count);
    EXPECT_LT((here.mean - there.mean).norm(), 0.5);
}

TEST_F(OSMesaPicture, TheCaptionIsInTheStripBelowWhateverItsLength)
{
    RenderScene scene = test::hall(5);
    scene.caption = {"a", "b"};
    const Image one = draw(scene, View::Top);
    scene.caption = {"xxxxxxxxxx", "yyyyyyyyyy"};
    const Image two = draw(scene, View::Top);
    int above = 0, below = 0;
    for (int y = 0; y < 400; ++y)
        for (int x = 0; x < 640; ++x)
            if (one.at(x, y) != two.at(x, y)) ++(y < 340 ? above : below);
    EXPECT_EQ(above, 0);
    EXPECT_GT(below, 50);
    scene.caption = std::vector<std::string>(40, std::string(300, '\xc3') + "\n\t");
    EXPECT_GT(draw(scene, View::Top).find(ofPath).count, 100);
    scene.caption.clear();
    EXPECT_GT(draw(scene, View::Top).find(ofPath).count, 100);
}

TEST(OSMesaRenderer, ReadsItsConfiguration)
{
    ConfigSection section(parseYaml(
        "width: 320\nheight: 240\nsupersampling: 1\nmax_points: 5000\ncut_ceiling: false"));
    OSMesaRenderer renderer;
    renderer.configure(section);
    section.rejectUnknown();
    EXPECT_EQ(renderer.config().width, 320);
    EXPECT_EQ(renderer.config().height, 240);
    EXPECT_EQ(renderer.config().supersampling, 1);
    EXPECT_EQ(renderer.config().max_points, 5000);
    EXPECT_FALSE(renderer.config().cut_ceiling);
}

TEST(OSMesaRenderer, RefusesPicturesThatMesaCannotDraw)
{
    OSMesaRenderer renderer;
    ConfigSection section(parseYaml("width: 9000"));
    EXPECT_THAT(
        [&] { renderer.configure(section); }, ThrowsMessage<ConfigError>(HasSubstr("9000")));
    EXPECT_EQ(renderer.config().width, 1600);
}
