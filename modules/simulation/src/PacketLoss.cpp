#include "taut/simulation/PacketLoss.h"

namespace taut::simulation
{
void declare(ConfigSection& section, PacketLoss& loss)
{
    section.key("share", loss.share, {0, 0.9}, "of the packets that never arrive");
    section.key("burst", loss.burst, {1, 1e6}, "mean number of packets lost in a row");
}

std::vector<bool> lostPackets(const PacketLoss& loss, std::size_t count, Random& random)
{
    const double recovers = 1 / loss.burst;
    const double fails = loss.share * recovers / (1 - loss.share);
    std::vector<bool> lost;
    bool now = random.uniform() < loss.share;
    for (std::size_t i = 0; i < count; i++)
    {
        lost.push_back(now);
        now = now ? random.uniform() >= recovers : random.uniform() < fails;
    }
    return lost;
}
}  // namespace taut::simulation
