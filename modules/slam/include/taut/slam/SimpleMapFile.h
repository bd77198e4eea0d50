#pragma once

#include <string>

#include "taut/slam/Mapper.h"

namespace taut
{
/** The map as MRPT's CSimpleMap, which its and MOLA's tools open: for each submap its pose, and its
 * points in its frame as a CObservationPointCloud labelled "taut".
 * Points are undistorted already and carry no time. Throws std::runtime_error if it cannot be
 * written. */
void writeSimpleMap(const std::string& path, const Mapper& mapper);
}  // namespace taut
