#pragma once

#include <mrpt/rtti/CObject.h>

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

/** Plug point: the local map that features are matched with. */
class Map : public mrpt::rtti::CObject
{
    DEFINE_VIRTUAL_MRPT_OBJECT(Map)
 public:
    virtual void configure(ConfigSection& section) = 0;

    /** One correspondence a query, Surface::None where nothing reliable is near. The result depends
     * on the map and the query alone, not on the number of threads. */
    virtual void match(
        const std::vector<MapPoint>& queries, std::vector<Correspondence>& correspondences,
        Executor& executor) const = 0;

    /** Adds undistorted points: the same map with any number of threads. */
    virtual void insert(const std::vector<MapPoint>& points, Executor& executor) = 0;

    /** Forgets what lies outside the window around the body: keeps the memory bounded. */
    virtual void slide(const Vector3d& center_world) = 0;

    virtual bool empty() const = 0;
    /** Number of cells or points held: for reports. */
    virtual std::size_t size() const = 0;
    virtual void clear() = 0;
};
}  // namespace taut
