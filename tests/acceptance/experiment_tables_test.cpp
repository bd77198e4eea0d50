/** The tables of docs/results.md: what the awk programs of experiments/ make of lines of results.
 */
#include <gmock/gmock.h>

#include <fstream>

#include "program.h"
#include "temporary_folder.h"

namespace
{
using namespace taut::test;
using testing::HasSubstr;

/** Columns as in experiments/common.sh; `points` is the error of the undistorted points [mm]. */
std::string lineOf(int seed, const std::string& variant, double points, double ms = 1)
{
    return "sweep,good,rate,180," + std::to_string(seed) + "," + variant + ",ok,7,8,0.1," +
           std::to_string(points) + ",9,2.5," + std::to_string(ms) + "\n";
}

class ExperimentTables : public testing::Test
{
 protected:
    std::string table(const std::string& program, const std::string& lines) const
    {
        std::ofstream(folder_ / "runs.csv") << lines;
        return runProgram("awk", program + " " + (folder_ / "runs.csv")).output;
    }
    const TemporaryFolder folder_;
};

TEST_F(ExperimentTables, GiveMeanAndDeviationOverTheSeedsAndCountWhatFailed)
{
    const std::string out = table(
        "-v rows='2 4' -v names='prior | rate' -v value=11 -v columns='imu bridge' -f " TAUT_SCRIPTS
        "/table.awk",
        lineOf(1, "imu", 1) + lineOf(2, "imu", 3) + lineOf(1, "bridge", 120) +
            "sweep,good,rate,180,2,bridge,failed,,,,,,,\n");
    EXPECT_EQ(
        out,
        "| prior | rate | imu | bridge |\n|---|---|---|---|\n"
        "| good | 180 | 2.00 ± 1.41 | 120 (1 failed) |\n");
}

TEST_F(ExperimentTables, TakeTheRatioOfModesOnTheSameRecording)
{
    std::string lines;
    for (const int seed : {1, 2})
        lines += lineOf(seed, "imu", 6.0 * seed) + lineOf(seed, "iterated", 3) +
                 lineOf(seed, "bridge", 2);
    lines += lineOf(3, "imu", 99);  // the others are still to come: no pair
    EXPECT_THAT(
        table("-f " TAUT_SCRIPTS "/gain.awk", lines),
        HasSubstr("| good | rate | 180 | 9.00 | 3.00 | 2.00 | 3.00 (2.00 to 4.00) | 4.50 (3.00 to "
                  "6.00) |\n"));
}

TEST_F(ExperimentTables, TakeTheCostRelativeToThatOfTheSameRound)
{
    const std::string lines = lineOf(1, "imu", 1, 10) + lineOf(1, "bridge", 1, 11) +
                              lineOf(2, "imu", 1, 20) + lineOf(2, "bridge", 1, 26);
    EXPECT_THAT(
        table("-v modes='imu bridge' -f " TAUT_SCRIPTS "/cost.awk", lines),
        HasSubstr("| bridge | 2.50 | 18.5 | 1.200 ± 0.141 |\n"));
}
}  // namespace
