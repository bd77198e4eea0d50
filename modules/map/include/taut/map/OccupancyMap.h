#pragma once

#include <octomap/OcTree.h>

#include <memory>
#include <string>
#include <vector>

#include "taut/core/Config.h"
#include "taut/core/Geometry.h"
#include "taut/core/VoxelSet.h"
#include "taut/core/Warning.h"

namespace taut
{
/** What is occupied, free and unknown in the world: an octomap::OcTree with rays. Too slow for the
 * odometry's path; see OccupancyWorker.
 *
 * Memory is bounded: when the tree has more than `max_nodes` nodes its resolution is halved, every
 * cell of 2 x 2 x 2 becoming one, as occupied as the most occupied of them. */
class OccupancyMap
{
 public:
    struct Config
    {
        double resolution = 0.2;  //!< edge of a cell [m]
        double max_range = 40;    //!< a longer ray tells only of free space, up to here [m]
        int max_nodes = 4'000'000;

        void declare(ConfigSection& section);
    };

    OccupancyMap() : OccupancyMap(Config{}) {}
    explicit OccupancyMap(const Config& config);

    /** Adds the rays from `origin` to the points, all in the world frame. Points that are not
     * finite are left out. Warns of points too far from the world's origin for the tree
     * ("occupancy_range") and of a halved resolution ("occupancy_coarser"), with the time `t` of
     * the scan. Throws std::invalid_argument if the origin is not finite. */
    void insert(
        Time t, const Vector3d& origin, const std::vector<Vector3d>& points,
        const WarningSink& warn);

    /** Writes the tree with its probabilities (.ot), or occupied and free only (.bt), as octovis
     * opens them. Throws std::runtime_error if it cannot. */
    void writeOt(const std::string& path) const;
    void writeBt(const std::string& path) const;

    const octomap::OcTree& tree() const;

    /** Edge of a cell now [m]: that of the configuration times a power of two. */
    double resolution() const { return tree_->getResolution(); }

 private:
    /** Adds a ray to each cell in which points ended, as octomap's insertPointCloud() does with
     * discretize, to the same result; cells that cannot become any freer are passed over, which
     * are most of those that rays cross. */
    void insertRays(const octomap::point3d& origin, const octomap::Pointcloud& ends);
    /** Inner nodes are brought up to date, and equal leaves merged, not after every insertion. */
    void updateInnerNodes() const;
    void halveResolution();

    Config config_;
    std::unique_ptr<octomap::OcTree> tree_;
    VoxelSet surely_free_;  //!< cells at the lower bound of their probability
    int inserted_ = 0;
};
}  // namespace taut
