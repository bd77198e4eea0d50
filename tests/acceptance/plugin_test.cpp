#include <gmock/gmock.h>

#include "slam_program.h"
#include "temporary_folder.h"

namespace
{
using namespace taut::test;
using testing::HasSubstr;

TEST(APlugin, AddsAFeatureExtractorByName)
{
    const TemporaryFolder folder;
    const std::string out = folder / "out";
    const ProgramRun run = slam(
        kSample, out, "-p " EVERY_NTH " -s features.type=example::EveryNth -s features.step=3");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(contentOf(out + "/config.yaml"), HasSubstr("type: 'example::EveryNth'"));
    EXPECT_THAT(contentOf(out + "/config.yaml"), HasSubstr("step: 3"));
    EXPECT_LT(positionError(kSampleTruth, out + "/trajectory.tum"), 0.0014);  // measured: 0.91 mm
}

TEST(APlugin, ThatIsNotLoadedIsNamed)
{
    const TemporaryFolder folder;
    const ProgramRun run = slam(kSample, folder / "out", "-s features.type=example::EveryNth");
    EXPECT_NE(run.exit_code, 0);
    EXPECT_THAT(run.output, HasSubstr("example::EveryNth"));
}

TEST(APlugin, ThatIsNotThereIsNamed)
{
    const TemporaryFolder folder;
    const ProgramRun run = slam(kSample, folder / "out", "-p " + (folder / "libabsent.so"));
    EXPECT_NE(run.exit_code, 0);
    EXPECT_THAT(run.output, HasSubstr("libabsent.so"));
}
}  // namespace
