#pragma once

#include <cstddef>
#include <vector>

#include "taut/core/Config.h"
#include "taut/simulation/Random.h"

namespace taut::simulation
{
/** Packets of a LiDAR that never arrive, in bursts: a chain of two states (Gilbert, Bell System
 * Technical Journal 39(5), 1960). */
struct PacketLoss
{
    double share = 0;  //!< of all packets
    double burst = 1;  //!< mean number lost in a row
};

void declare(ConfigSection& section, PacketLoss& loss);

/** Which of `count` packets in a row are lost. share <= burst / (1 + burst). */
std::vector<bool> lostPackets(const PacketLoss& loss, std::size_t count, Random& random);
}  // namespace taut::simulation
