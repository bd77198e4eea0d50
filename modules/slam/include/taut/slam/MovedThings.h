#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "taut/core/Voxel.h"
#include "taut/slam/Mapper.h"

namespace taut
{
/** What was seen and is not there any more: people, cars. Judges voxels of 0.2 m. One has gone if,
 * after the last return in it, two key scans at least looked through it; and so have its neighbours
 * that nothing was seen in since and that one key scan looked past. Looks at the submaps of a
 * mapper's results, along the final path. */
class MovedThings
{
 public:
    /** A scan in the order in which they were made: position of its submap in the graph, and which
     * of it. */
    using Moment = std::pair<std::size_t, std::uint16_t>;

    MovedThings(Mapper& mapper, Executor& executor);

    /** A point of the map (world frame of the results [m]) and when it was seen; in the order of
     * time. */
    void add(const Vector3d& p_world, Moment moment);

    /** After all points: looks through them with the key scans. Gives the number of voxels that
     * have gone. */
    std::size_t decide();

    /** After decide(): whether what was seen at a point has gone. */
    bool haveLeft(const Vector3d& p_world) const;

 private:
    using Vector3f = Eigen::Vector3f;
    struct Voxel
    {
        Vector3f point;                     //!< the first one in it
        Moment last_return;                 //!< in it, or on a surface that goes through it
        std::vector<Moment> through, past;  //!< key scans that looked so, the last ones
        bool gone = false;
    };
    /** Voxels that a submap saw first. */
    using Fresh = std::vector<std::uint64_t>;

    /** A key scan and when it was made. */
    struct Look
    {
        std::shared_ptr<const Submap> submap;  // owns the key scan
        const KeyScan* key;
        Moment now;
    };

    void lookAt(std::size_t position, const Fresh& fresh);
    std::vector<Look> looksAround(std::size_t position) const;
    void findLastReturns();
    void spread();
    std::vector<std::size_t> around(std::size_t position) const;
    std::vector<Vector3d> normalsOf(std::size_t position, const Fresh& fresh);
    const Pose& poseOf(std::size_t position) const
    {
        return graph_.vertices[position].T_world_submap;
    }

    Mapper& mapper_;
    Executor& executor_;
    PoseGraph graph_;  // of the results
    std::unordered_map<std::uint64_t, Voxel, VoxelHash> voxels_;
    std::vector<Fresh> fresh_;  // of each submap
};
}  // namespace taut
