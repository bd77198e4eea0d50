#pragma once

#include <string>
#include <vector>

#include "BagReader.h"
#include "taut/packets/ouster/SensorInfo.h"

namespace taut::bag
{
/** The description of the Ouster whose packets are in a bag: from the file that is given, else from
 * a topic of strings whose name ends with "metadata" (one beside the LiDAR's before others), else
 * from the bag's name with .json. Throws std::runtime_error naming what was tried. */
ouster::SensorInfo findOusterDescription(
    const std::string& path, const std::vector<BagTopic>& topics, const BagTopic& lidar,
    const std::string& given);
}  // namespace taut::bag
