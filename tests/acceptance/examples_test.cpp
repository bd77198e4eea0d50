// The programs in examples/, as their comments say that they are run.
#include <gmock/gmock.h>

#include "program.h"
#include "taut/trajectory/Scores.h"
#include "taut/trajectory/TrajectoryFile.h"
#include "temporary_folder.h"

namespace
{
using namespace taut;
using namespace taut::test;
using testing::HasSubstr;

const std::string kFolder = EXAMPLES "/";

TEST(Examples, ARunIsEmbeddedAndItsResultsAreRead)
{
    const TemporaryFolder folder;
    const std::string out = folder / "out", log = TAUT_RAWLOGS "/hall_fast";
    const ProgramRun embed = runProgram(kFolder + "example_embed", log + ".rawlog " + out + " 3");
    ASSERT_EQ(embed.exit_code, 0) << embed.output;
    EXPECT_THAT(embed.output, HasSubstr("started at rest"));
    const auto scores = scoreTrajectory(readTum(log + ".gt.tum"), readTum(out + "/trajectory.tum"));
    EXPECT_LT(scores.absolute.position.rmse, 0.0013);

    const ProgramRun read = runProgram(kFolder + "example_read_results", out);
    ASSERT_EQ(read.exit_code, 0) << read.output;
    EXPECT_THAT(read.output, HasSubstr("poses over"));
    EXPECT_THAT(read.output, HasSubstr("points, the highest at"));
}

TEST(Examples, ALiveOneTellsAPoseAScan)
{
    const ProgramRun run = runProgram(kFolder + "example_live", "");
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("2.9 s: "));
    EXPECT_THAT(run.output, Not(HasSubstr("pose_doubtful")));
}
}  // namespace
