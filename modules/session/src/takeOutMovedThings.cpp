#include "takeOutMovedThings.h"

#include "taut/slam/MovedThings.h"

namespace taut
{
namespace
{
/** A scan of the results: the position of its submap, and which of it. */
struct Moment
{
    Time t = 0;
    std::size_t position = 0;
    std::uint16_t scan = 0;
};

/** Of all scans of the results, run by run. */
std::vector<Moment> momentsOf(const Mapper& mapper)
{
    std::vector<Moment> moments;
    const PoseGraph graph = mapper.resultGraph();
    for (std::size_t position = 0; position < graph.vertices.size(); position++)
    {
        const auto submap = mapper.submap(graph.vertices[position].id);
        for (std::size_t i = 0; i < submap->scans.size(); i++)
            moments.push_back({submap->scans[i].t, position, static_cast<std::uint16_t>(i)});
    }
    return moments;
}
}  // namespace

std::size_t takeOutMovedThings(Mapper& mapper, MapExport& map, Executor& executor)
{
    MovedThings things(mapper, executor);
    const std::vector<Moment> moments = momentsOf(mapper);
    // The scans of the map are scans of the submaps, in the same order.
    auto moment = moments.begin();
    std::size_t position = 0;
    std::vector<MovedThings::Seen> points;  // of the submap there
    map.forPoints(
        [&](Time t, const Vector3d& p_world)
        {
            while (moment != moments.end() && moment->t != t) ++moment;
            if (moment == moments.end()) return;
            if (moment->position != position)
            {
                things.judge(position, points);
                points.clear();
                position = moment->position;
            }
            points.push_back({p_world.cast<float>(), moment->scan});
        });
    things.judge(position, points);
    if (things.none()) return 0;
    return map.takeOut([&](const Vector3d& p_world) { return things.haveLeft(p_world); });
}
}  // namespace taut
