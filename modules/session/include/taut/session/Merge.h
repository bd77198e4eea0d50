#pragma once

#include <string>
#include <vector>

#include "taut/core/WarningLog.h"
#include "taut/session/Method.h"

namespace taut
{
struct MergeConfig
{
    Method method;                     //!< of which `slam`, `map_export` and `renderer` are used
    std::vector<std::string> folders;  //!< results of runs of one place; the first gives the frame
    std::string folder;                //!< of the results; has to be there
    int threads = 1;
    bool pictures = true;
};

struct MergeOutcome
{
    /** Of `folders`, those that no loop joined to the others: not in the results. */
    std::vector<std::string> apart;
    std::size_t runs = 0, submaps = 0, loops = 0;  //!< in the results; loops between runs
    std::size_t map_points = 0;
    bool pictures_failed = false;
};

/** Joins the results of several runs of one place, each run for itself, to one graph and one map in
 * the frame of the first: searches for the places that they share, run by run, until no more can be
 * joined. Writes graph.g2o, loops.csv, submaps/, map.simplemap, map.ply, map.ot, map.bt,
 * snapshots, metrics.json and, for each run that is in, trajectory_N.tum (N from 1, in the order in
 * which they were joined). The results are a known map like those of a single run. The given
 * folders stay as they are.
 *
 * The map is made of the points of the submaps: the recordings are not read again.
 *
 * Warnings: `place_unknown` for each run that stays apart. Throws std::runtime_error if a folder
 * holds no map, or if no two runs can be joined. */
MergeOutcome mergeRuns(const MergeConfig& config, WarningLog& warnings);
}  // namespace taut
