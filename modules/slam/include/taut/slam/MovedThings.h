#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "taut/core/VoxelSet.h"
#include "taut/slam/Mapper.h"

namespace taut
{
/** What was seen and is not there any more: people, cars. Judges voxels of 0.2 m. One has gone if,
 * after the last return in it, two key scans at least looked through it; and so have its neighbours
 * that nothing was seen in since and that one key scan looked past. Looks at the submaps of a
 * mapper's results, along the final path. Memory is that of one submap and a few bytes a voxel. */
class MovedThings
{
 public:
    MovedThings(Mapper& mapper, Executor& executor);

    /** A point of the map, and which scan of its submap saw it. */
    struct Seen
    {
        Eigen::Vector3f point;  //!< world frame of the results [m]
        std::uint16_t scan = 0;
    };

    /** The points of the submap at a position of the results' graph, in the order of the scans;
     * submap after submap. Looks at those that no submap before has seen. */
    void judge(std::size_t position, const std::vector<Seen>& points);

    /** After all submaps: whether what was seen at a point (world frame [m]) has gone. */
    bool haveLeft(const Vector3d& p_world) const;
    bool none() const { return gone_.size() == 0; }

 private:
    /** A scan in the order in which they were made: position of its submap, and which of it. */
    using Moment = std::pair<std::size_t, std::uint16_t>;
    struct Voxel
    {
        Vector3d point;                     //!< the first one in it
        Vector3d normal;                    //!< of the surface that it is of; zero: it is of none
        Moment last_return;                 //!< in it, or on a surface that goes through it
        std::vector<Moment> through, past;  //!< key scans that looked so, the last ones
        bool gone = false;
    };
    using Voxels = std::unordered_map<std::uint64_t, Voxel, VoxelHash>;
    /** A key scan and when it was made. */
    struct Look
    {
        std::shared_ptr<const Submap> submap;  // owns the key scan
        const KeyScan* key;
        Moment now;
    };

    Voxels freshVoxels(std::size_t position, const std::vector<Seen>& points);
    void findNormals(std::size_t position, Voxels& voxels);
    std::vector<std::size_t> around(std::size_t position) const;
    std::vector<Look> looksFrom(const std::vector<std::size_t>& submaps) const;
    void lookAt(Voxels& voxels, const std::vector<Look>& looks);
    void findLastReturns(Voxels& voxels, const std::vector<std::size_t>& submaps) const;
    void decide(Voxels& voxels);
    const Pose& poseOf(std::size_t position) const
    {
        return graph_.vertices[position].T_world_submap;
    }

    Mapper& mapper_;
    Executor& executor_;
    PoseGraph graph_;  // of the results
    VoxelSet seen_, gone_;
};
}  // namespace taut
