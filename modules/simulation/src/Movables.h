#pragma once

#include <functional>
#include <vector>

#include "taut/simulation/World.h"

namespace taut::simulation
{
/** Things that may stand elsewhere in another session, and the places there are for them. */
class Movables
{
 public:
    using Thing = std::function<void(Mesh& mesh, const Pose& T_world_thing)>;  // adds itself

    void add(Thing thing, const Pose& T_world_place);
    void addFreePlace(const Pose& T_world_place) { free_.push_back(T_world_place); }

    /** Adds all things to a mesh, in the order in which they came: config.moved of them on places
     * that were free. What moves, and where to, is drawn from config.moved_seed alone. Throws
     * std::runtime_error if something is to move and no place is free. */
    void addTo(Mesh& mesh, const WorldConfig& config) const;

 private:
    std::vector<Thing> things_;
    std::vector<Pose> places_;  // of the things
    std::vector<Pose> free_;
};
}  // namespace taut::simulation
