#include "Movables.h"

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "taut/simulation/Random.h"

namespace taut::simulation
{
void Movables::add(Thing thing, const Pose& T_world_place)
{
    things_.push_back(std::move(thing));
    places_.push_back(T_world_place);
}

void Movables::addTo(Mesh& mesh, const WorldConfig& config) const
{
    Random random(static_cast<std::uint64_t>(config.moved_seed), 4);
    std::vector<std::size_t> order(things_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    shuffle(order, random);
    order.resize(
        static_cast<std::size_t>(std::lround(config.moved * static_cast<double>(order.size()))));
    if (!order.empty() && free_.empty())
        throw std::runtime_error(
            "world.moved: this world has no free place; another world.seed may have one");

    std::vector<Pose> places = places_, free = free_;
    for (const std::size_t thing : order)  // the place that one leaves is free for the next
        std::swap(places[thing], free[random.below(free.size())]);
    for (std::size_t i = 0; i < things_.size(); i++) things_[i](mesh, places[i]);
}
}  // namespace taut::simulation
