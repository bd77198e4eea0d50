/** What holds for every renderer. */
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "NullRenderer.h"
#include "structures.h"
#include "taut/core/Plugins.h"
#include "taut/render/OSMesaRenderer.h"
#include "temporary_folder.h"

using namespace taut;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

IMPLEMENTS_MRPT_OBJECT(NullRenderer, taut::Renderer, taut::test)

namespace
{
class AnyRenderer : public ::testing::TestWithParam<std::string>
{
 protected:
    AnyRenderer()
    {
        registerRenderers();
        mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(NullRenderer, taut::test));
        ConfigSection section;
        renderer_ = createConfigured<Renderer>(section, GetParam());
        section.rejectUnknown();
    }

    void expectRefused(const RenderScene& scene, View view, const std::string& cause)
    {
        EXPECT_THAT(
            [&] { renderer_->render(scene, view, path_); },
            ThrowsMessage<std::runtime_error>(HasSubstr(cause)));
        EXPECT_FALSE(std::filesystem::exists(path_));
    }

    test::TemporaryFolder folder_;
    std::string path_ = folder_ / "picture.png";
    std::shared_ptr<Renderer> renderer_;
};
}  // namespace

TEST_P(AnyRenderer, WritesAFileForEachView)
{
    const RenderScene scene = test::hall(2);
    for (const View view : kAllViews)
    {
        const std::string path = folder_ / (std::string(nameOf(view)) + ".png");
        renderer_->render(scene, view, path);
        EXPECT_TRUE(std::filesystem::exists(path)) << path;
    }
}

TEST_P(AnyRenderer, RefusesASceneWithNothingInIt)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    RenderScene scene;
    expectRefused(scene, View::Top, "nothing to draw");
    scene.points.assign(10, {nan, 0, 0});
    expectRefused(scene, View::Oblique, "nothing to draw");
}

TEST_P(AnyRenderer, RefusesToFollowWithoutATrajectory)
{
    RenderScene scene = test::hall(2);
    scene.trajectory.clear();
    expectRefused(scene, View::Follow, "no trajectory");
}

TEST_P(AnyRenderer, NamesThePoseThatIsNotFinite)
{
    RenderScene scene = test::hall(2);
    scene.trajectory[7].p.y() = std::numeric_limits<double>::infinity();
    expectRefused(scene, View::Top, "pose 7 ");
}

TEST_P(AnyRenderer, SaysWhichFileCannotBeWritten)
{
    const std::string path = folder_ / "no/such/folder.png";
    EXPECT_THAT(
        [&] { renderer_->render(test::hall(2), View::Top, path); },
        ThrowsMessage<std::runtime_error>(HasSubstr(path)));
}

INSTANTIATE_TEST_SUITE_P(
    Renderers, AnyRenderer, ::testing::Values("taut::OSMesaRenderer", "taut::test::NullRenderer"),
    [](const auto& test) { return test.param.substr(test.param.rfind(':') + 1); });
