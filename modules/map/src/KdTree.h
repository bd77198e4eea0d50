#pragma once

#include <cstdint>
#include <memory>
#include <nanoflann.hpp>
#include <vector>

#include "taut/map/VoxelForest.h"

namespace taut
{
/** An immutable kd-tree over the cells [first, first + size) of a forest. */
class KdTree
{
 public:
    /** `points` must not be empty. */
    KdTree(std::uint32_t first, std::vector<Eigen::Vector3f> points)
        : first_(first),
          points_(std::move(points)),
          index_(3, *this, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize))
    {
    }
    KdTree(const KdTree&) = delete;
    KdTree& operator=(const KdTree&) = delete;

    std::uint32_t first() const { return first_; }
    std::size_t size() const { return points_.size(); }

    /** Adds what is nearer than those found so far; `found.distances2[wanted - 1]` bounds the
     * search. */
    void search(const Eigen::Vector3f& query, std::size_t wanted, Neighbours& found) const
    {
        Collector collector{first_, wanted, found};
        index_.findNeighbors(collector, query.data(), nanoflann::SearchParams());
    }

    // What nanoflann asks of a data set.
    std::size_t kdtree_get_point_count() const { return points_.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const
    {
        return points_[i][static_cast<Eigen::Index>(axis)];
    }
    template <class BoundingBox>
    bool kdtree_get_bbox(BoundingBox&) const
    {
        return false;
    }

 private:
    static constexpr std::size_t kLeafSize = 16;

    /** What nanoflann asks of a result: keeps the nearest in order. */
    struct Collector
    {
        std::uint32_t first;
        std::size_t wanted;
        Neighbours& found;

        float worstDist() const { return found.distances2[wanted - 1]; }
        bool full() const { return found.count == wanted; }
        bool addPoint(float distance2, std::uint32_t i)
        {
            if (distance2 >= worstDist()) return true;  // nanoflann's own bound may be older
            std::size_t at = full() ? wanted - 1 : found.count++;
            for (; at > 0 && found.distances2[at - 1] > distance2; at--)
            {
                found.distances2[at] = found.distances2[at - 1];
                found.cells[at] = found.cells[at - 1];
            }
            found.distances2[at] = distance2;
            found.cells[at] = first + i;
            return true;
        }
    };

    std::uint32_t first_;
    std::vector<Eigen::Vector3f> points_;
    nanoflann::KDTreeSingleIndexAdaptor<
        nanoflann::L2_Simple_Adaptor<float, KdTree>, KdTree, 3, std::uint32_t>
        index_;
};
}  // namespace taut
