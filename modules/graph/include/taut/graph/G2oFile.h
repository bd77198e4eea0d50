#pragma once

#include <string>

#include "taut/core/PoseGraph.h"

/** \file G2oFile.h
 * Pose graphs as g2o's text: VERTEX_SE3:QUAT, EDGE_SE3:QUAT and FIX, which other programs open.
 *
 * g2o tells an edge's information of (translation, vector part of the quaternion). The vector part
 * is theta / 2, so that its information is four times that of theta, and the mixed block twice.
 *
 * What g2o has no word for stands in comments that begin with `#taut`: how many elements the file
 * has, edges that are loop closures, edges that are not enabled, and gravity. In files without
 * them, edges between consecutive ids are odometry and all others loop closures. */
namespace taut
{
/** With 17 digits, independent of the locale. The file appears under its name when it is complete.
 * Throws std::runtime_error if it cannot be written. */
void writeG2o(const std::string& path, const PoseGraph& graph);

/** Throws std::runtime_error with file and line if the file is damaged, holds other elements, or a
 * graph that GraphOptimizer would refuse. Lines PARAMS_... say nothing of poses and are skipped. */
PoseGraph readG2o(const std::string& path);
}  // namespace taut
