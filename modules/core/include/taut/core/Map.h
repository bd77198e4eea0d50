#pragma once

#include <mrpt/rtti/CObject.h>

#include <any>
#include <cstddef>
#include <vector>

#include "taut/core/Config.h"
#include "taut/core/Correspondence.h"
#include "taut/core/Features.h"
#include "taut/core/Parallel.h"

namespace taut
{
/** A point in the world frame, the kind of surface it lies on and the side it was seen from. */
struct MapPoint
{
    Vector3d position = Vector3d::Zero();  //!< [m], world frame
    FeatureKind kind = FeatureKind::Any;
    Vector3d view = Vector3d::Zero();  //!< unit vector to the sensor; zero: not known
};

/** What a caller of Map::match() keeps from one call to the next, so that memory and look-ups are
 * used again while the queries move a little. It changes no result: a fresh one gives the same
 * bits. One map after the other may be given the same scratch, two threads at once may not. */
class MapScratch
{
 public:
    /** The content that a map of one class keeps here: made anew if another class had it last. */
    template <class Content>
    Content& as()
    {
        if (auto* content = std::any_cast<Content>(&content_)) return *content;
        return content_.emplace<Content>();
    }

 private:
    std::any content_;
};

/** Plug point: the local map that features are matched with.
 *
 * Threads: const functions change nothing and may be called on one map by several threads at once,
 * match() with a scratch and an executor for each. No thread may use the map while another one
 * calls a function that is not const. */
class Map : public mrpt::rtti::CObject
{
    DEFINE_VIRTUAL_MRPT_OBJECT(Map)
 public:
    virtual void configure(ConfigSection& section) = 0;

    /** One correspondence a query, Surface::None where nothing reliable is near. Each depends on
     * the map and its query alone: not on the other queries, nor on those before, nor on the number
     * of threads. The map follows from what was inserted and slid, not from what was matched. */
    virtual void match(
        const std::vector<MapPoint>& queries, std::vector<Correspondence>& correspondences,
        MapScratch& scratch, Executor& executor) const = 0;

    /** Adds undistorted points: the same map with any number of threads. */
    virtual void insert(const std::vector<MapPoint>& points, Executor& executor) = 0;

    /** Takes over what match() worked out with a scratch since the map last changed, so that it
     * need not be worked out again after the next insertion. This changes no answer before that
     * one; later a map may answer by what was kept, which is up to a fifth older. */
    virtual void keep(MapScratch& /*scratch*/) {}

    /** Forgets what lies outside the window around the body: keeps the memory bounded. */
    virtual void slide(const Vector3d& center_world) = 0;

    virtual bool empty() const = 0;
    /** Number of cells or points held: for reports. */
    virtual std::size_t size() const = 0;
    virtual void clear() = 0;
};
}  // namespace taut
