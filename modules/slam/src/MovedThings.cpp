#include "taut/slam/MovedThings.h"

#include <algorithm>

#include "taut/core/Voxel.h"
#include "taut/loops/CommonView.h"
#include "taut/loops/SubmapRegistration.h"

namespace taut
{
namespace
{
constexpr double kInverseVoxel = 5;     // [1/m]
constexpr double kReach = 25;           // [m] of a look: there, a cell of a key scan is 0.7 m wide
constexpr std::size_t kMostAround = 8;  // submaps that are asked, the nearest
constexpr std::size_t kMostKeyScans = 32;  // of all these
constexpr std::size_t kMostLooks = 8;      // that are remembered of a voxel
constexpr std::ptrdiff_t kFewestLooks = 2;
constexpr int kSpread =
    4;  // voxels that what has gone may reach further than it was looked through

template <class Moment>
void remember(std::vector<Moment>& looks, Moment moment)
{
    const auto at = std::lower_bound(looks.begin(), looks.end(), moment);
    if (at != looks.end() && *at == moment) return;
    looks.insert(at, moment);
    if (looks.size() > kMostLooks) looks.erase(looks.begin());  // the last ones decide
}

template <class Moment>
std::ptrdiff_t countAfter(const std::vector<Moment>& looks, Moment moment)
{
    return looks.end() - std::upper_bound(looks.begin(), looks.end(), moment);
}

/** The voxels around one, and itself. */
template <class Visit>
void forAround(std::uint64_t voxel, const Visit& visit)
{
    const auto x = voxel >> 42, y = voxel >> 21, z = voxel;
    for (std::uint64_t i = 0; i < 27; i++)
        visit(packVoxel(x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1));
}
}  // namespace

MovedThings::MovedThings(Mapper& mapper, Executor& executor)
    : mapper_(mapper), executor_(executor), graph_(mapper.resultGraph())
{
}

void MovedThings::judge(std::size_t position, const std::vector<Seen>& points)
{
    Voxels voxels = freshVoxels(position, points);
    if (voxels.empty()) return;
    findNormals(position, voxels);
    const std::vector<std::size_t> submaps = around(position);
    lookAt(voxels, looksFrom(submaps));
    findLastReturns(voxels, submaps);
    decide(voxels);
}

MovedThings::Voxels MovedThings::freshVoxels(std::size_t position, const std::vector<Seen>& points)
{
    Voxels voxels;
    for (const Seen& s : points)
    {
        const Vector3d p = s.point.cast<double>();
        const std::uint64_t key = voxelKey(p, kInverseVoxel);
        if (seen_.insert(key)) voxels[key].point = p;
        const auto voxel = voxels.find(key);
        if (voxel != voxels.end()) voxel->second.last_return = {position, s.scan};
    }
    return voxels;
}

void MovedThings::findNormals(std::size_t position, Voxels& voxels)
{
    const SubmapView view = mapper_.viewOf(graph_.vertices[position].id);
    const Pose T_submap_world = poseOf(position).inverse();
    std::vector<MapPoint> points;
    for (const auto& [key, voxel] : voxels)
    {
        const Vector3d p = T_submap_world * voxel.point;
        const Vector3d seen_from = view.submap->scans[voxel.last_return.second].T_submap_imu.p;
        points.push_back({p, FeatureKind::Any, (seen_from - p).normalized()});
    }
    const std::vector<Vector3d> normals =
        SubmapRegistration(*view.map, executor_).normalsOf(points);
    auto normal = normals.begin();
    for (auto& [key, voxel] : voxels) voxel.normal = poseOf(position).R * *normal++;
}

/* The submap itself, and those after it that see the same place. */
std::vector<std::size_t> MovedThings::around(std::size_t position) const
{
    const double reach = mapper_.submap(graph_.vertices[position].id)->reach;
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t other = position; other < graph_.vertices.size(); other++)
    {
        const double apart = (poseOf(other).p - poseOf(position).p).norm();
        if (apart < 2 * reach) near.emplace_back(apart, other);
    }
    std::sort(near.begin(), near.end());
    std::vector<std::size_t> nearest;
    for (std::size_t i = 0; i < std::min(near.size(), kMostAround); i++)
        nearest.push_back(near[i].second);
    return nearest;
}

/* Key scans of these submaps, evenly thinned. */
std::vector<MovedThings::Look> MovedThings::looksFrom(const std::vector<std::size_t>& submaps) const
{
    std::vector<Look> all;
    for (const std::size_t position : submaps)
    {
        const auto submap = mapper_.submap(graph_.vertices[position].id);
        for (const KeyScan& key : submap->key_scans)
            all.push_back({submap, &key, {position, key.scan}});
    }
    std::vector<Look> looks;
    const std::size_t count = std::min(all.size(), kMostKeyScans);
    for (std::size_t i = 0; i < count; i++) looks.push_back(all[i * all.size() / count]);
    return looks;
}

void MovedThings::lookAt(Voxels& voxels, const std::vector<Look>& looks)
{
    std::vector<Voxel*> all;
    for (auto& [key, voxel] : voxels) all.push_back(&voxel);
    for (const Look& look : looks)
    {
        const Pose T_sensor_world = (poseOf(look.now.first) * look.key->T_submap_sensor).inverse();
        executor_.forChunks(
            all.size(), 1024,
            [&](std::size_t, std::size_t begin, std::size_t end)
            {
                for (std::size_t i = begin; i < end; i++)
                {
                    Voxel& voxel = *all[i];
                    const Vector3d p = T_sensor_world * voxel.point;
                    if (p.squaredNorm() > square(kReach)) continue;
                    const Visibility seen =
                        visibilityOf(p, T_sensor_world.R * voxel.normal, *look.key);
                    if (seen == Visibility::Surface)
                        voxel.last_return = std::max(voxel.last_return, look.now);
                    if (seen != Visibility::Free && seen != Visibility::Past) continue;
                    remember(voxel.past, look.now);
                    // What is no plane, such as a person, is not flat along any ray.
                    if (seen == Visibility::Free || voxel.normal.isZero())
                        remember(voxel.through, look.now);
                }
            });
    }
}

/* map.ply keeps the first point at a place alone; the submaps tell of those that came later. */
void MovedThings::findLastReturns(Voxels& voxels, const std::vector<std::size_t>& submaps) const
{
    for (const std::size_t position : submaps)
    {
        const auto submap = mapper_.submap(graph_.vertices[position].id);
        for (const SubmapPoint& p : submap->points)
        {
            const Vector3d p_world = poseOf(position) * Vector3d(p.position.cast<double>());
            const auto found = voxels.find(voxelKey(p_world, kInverseVoxel));
            if (found == voxels.end()) continue;
            found->second.last_return =
                std::max(found->second.last_return, Moment(position, p.scan));
        }
    }
}

void MovedThings::decide(Voxels& voxels)
{
    std::vector<std::uint64_t> front;
    const auto leave = [&](std::uint64_t key, Voxel& voxel)
    {
        voxel.gone = true;
        gone_.insert(key);
        front.push_back(key);
    };
    for (auto& [key, voxel] : voxels)
        if (countAfter(voxel.through, voxel.last_return) >= kFewestLooks) leave(key, voxel);
    for (int step = 0; step < kSpread; step++)
    {
        std::vector<std::uint64_t> last;
        last.swap(front);
        for (const std::uint64_t key : last)
            forAround(
                key,
                [&](std::uint64_t around)
                {
                    const auto found = voxels.find(around);
                    if (found == voxels.end() || found->second.gone) return;
                    if (countAfter(found->second.past, found->second.last_return) > 0)
                        leave(around, found->second);
                });
    }
}

bool MovedThings::haveLeft(const Vector3d& p_world) const
{
    return gone_.contains(voxelKey(p_world, kInverseVoxel));
}
}  // namespace taut
