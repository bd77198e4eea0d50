#include "takeOutMovedThings.h"

#include "taut/slam/MovedThings.h"

namespace taut
{
namespace
{
using Moments = std::vector<std::pair<Time, MovedThings::Moment>>;

/** Of all scans of the results, run by run. */
Moments momentsOf(const Mapper& mapper)
{
    Moments moments;
    const PoseGraph graph = mapper.resultGraph();
    for (std::size_t position = 0; position < graph.vertices.size(); position++)
    {
        const auto submap = mapper.submap(graph.vertices[position].id);
        for (std::size_t i = 0; i < submap->scans.size(); i++)
            moments.push_back({submap->scans[i].t, {position, static_cast<std::uint16_t>(i)}});
    }
    return moments;
}
}  // namespace

std::size_t takeOutMovedThings(Mapper& mapper, MapExport& map, Executor& executor)
{
    MovedThings things(mapper, executor);
    const Moments moments = momentsOf(mapper);
    // The scans of the map are scans of the submaps, in the same order.
    auto moment = moments.begin();
    map.forPoints(
        [&](Time t, const Vector3d& p_world)
        {
            while (moment != moments.end() && moment->first != t) ++moment;
            if (moment != moments.end()) things.add(p_world, moment->second);
        });
    if (things.decide() == 0) return 0;
    return map.takeOut([&](const Vector3d& p_world) { return things.haveLeft(p_world); });
}
}  // namespace taut
