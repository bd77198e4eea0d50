#pragma once

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "program.h"
#include "taut/trajectory/Scores.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace taut::test
{
inline const std::string kSample = TAUT_RAWLOGS "/hall_fast.rawlog";
inline const std::string kSampleTruth = TAUT_RAWLOGS "/hall_fast.gt.tum";

inline ProgramRun slam(const std::string& arguments)
{
    return runProgram(TAUT_SLAM, arguments);
}

/** Without pictures, which take longer than the rest. */
inline ProgramRun slam(
    const std::string& log, const std::string& folder, const std::string& more = "")
{
    return slam("-i " + log + " -o " + folder + " --no-pictures --threads 1 " + more);
}

/** RMSE of the positions after SE(3) alignment [m]. */
inline double positionError(const std::string& truth, const std::string& estimate)
{
    return scoreTrajectory(readTum(truth), readTum(estimate)).absolute.position.rmse;
}

inline std::string contentOf(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}
}  // namespace taut::test
