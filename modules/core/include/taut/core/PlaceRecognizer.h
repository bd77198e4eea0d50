#pragma once

#include <mrpt/rtti/CObject.h>

#include <functional>
#include <optional>
#include <vector>

#include "taut/core/Config.h"
#include "taut/core/LoopClosure.h"
#include "taut/core/Submap.h"

namespace taut
{
/** What is known of where submaps are to each other when candidates are asked for. */
struct PlaceKnowledge
{
    std::function<Pose(VertexId)> pose;  //!< T_world_submap as the graph has it
    /** Covariance of T_from_to as the graph has it, in the tangent of RelativeEdge; nothing where
     * no edges join the two. */
    std::function<std::optional<Matrix6d>(VertexId from, VertexId to)> covariance;
};

/** Plug point: finds submaps that may show the same place. */
class PlaceRecognizer : public mrpt::rtti::CObject
{
    DEFINE_VIRTUAL_MRPT_OBJECT(PlaceRecognizer)
 public:
    virtual void configure(ConfigSection& section) = 0;

    /** Remembers what it needs of a submap. Ids increase. */
    virtual void add(const Submap& submap) = 0;

    /** Submaps added before `id` that may show what submap `id` shows, the most likely first. The
     * same submaps and knowledge give the same candidates. */
    virtual std::vector<LoopCandidate> candidates(
        VertexId id, const PlaceKnowledge& knowledge) const = 0;
};
}  // namespace taut
