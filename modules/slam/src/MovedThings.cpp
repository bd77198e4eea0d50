#include "taut/slam/MovedThings.h"

#include <algorithm>

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

using Moment = MovedThings::Moment;

void remember(std::vector<Moment>& looks, Moment moment)
{
    const auto at = std::lower_bound(looks.begin(), looks.end(), moment);
    if (at != looks.end() && *at == moment) return;
    looks.insert(at, moment);
    if (looks.size() > kMostLooks) looks.erase(looks.begin());  // the last ones decide
}

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
    : mapper_(mapper),
      executor_(executor),
      graph_(mapper.resultGraph()),
      fresh_(graph_.vertices.size())
{
}

void MovedThings::add(const Vector3d& p_world, Moment moment)
{
    const std::uint64_t key = voxelKey(p_world, kInverseVoxel);
    const auto [voxel, is_new] = voxels_.try_emplace(key);
    voxel->second.last_return = moment;
    if (!is_new) return;
    voxel->second.point = p_world.cast<float>();
    fresh_[moment.first].push_back(key);
}

std::size_t MovedThings::decide()
{
    for (std::size_t position = 0; position < fresh_.size(); position++)
        lookAt(position, fresh_[position]);
    findLastReturns();
    for (auto& [key, voxel] : voxels_)
        voxel.gone = countAfter(voxel.through, voxel.last_return) >= kFewestLooks;
    spread();
    return static_cast<std::size_t>(std::count_if(
        voxels_.begin(), voxels_.end(), [](const auto& entry) { return entry.second.gone; }));
}

/* Looks at what a submap saw first, with its own key scans and those of the submaps after it. */
void MovedThings::lookAt(std::size_t position, const Fresh& fresh)
{
    std::vector<Voxel*> voxels;
    for (const std::uint64_t key : fresh) voxels.push_back(&voxels_.at(key));
    const std::vector<Vector3d> normals = normalsOf(position, fresh);
    for (const Look& look : looksAround(position))
    {
        const Pose T_sensor_world = (poseOf(look.now.first) * look.key->T_submap_sensor).inverse();
        executor_.forChunks(
            voxels.size(), 1024,
            [&](std::size_t, std::size_t begin, std::size_t end)
            {
                for (std::size_t i = begin; i < end; i++)
                {
                    Voxel& voxel = *voxels[i];
                    const Vector3d p = T_sensor_world * Vector3d(voxel.point.cast<double>());
                    if (p.squaredNorm() > square(kReach)) continue;
                    const Visibility seen =
                        visibilityOf(p, T_sensor_world.R * normals[i], *look.key);
                    if (seen == Visibility::Surface)
                        voxel.last_return = std::max(voxel.last_return, look.now);
                    if (seen != Visibility::Free && seen != Visibility::Past) continue;
                    remember(voxel.past, look.now);
                    // What is no plane, such as a person, is not flat along any ray.
                    if (seen == Visibility::Free || normals[i].isZero())
                        remember(voxel.through, look.now);
                }
            });
    }
}

/* Key scans of the submap and of those after it around, evenly thinned. */
std::vector<MovedThings::Look> MovedThings::looksAround(std::size_t position) const
{
    std::vector<Look> all;
    for (const std::size_t other : around(position))
    {
        const auto submap = mapper_.submap(graph_.vertices[other].id);
        for (const KeyScan& key : submap->key_scans)
            all.push_back({submap, &key, {other, key.scan}});
    }
    std::vector<Look> looks;
    const std::size_t count = std::min(all.size(), kMostKeyScans);
    for (std::size_t i = 0; i < count; i++) looks.push_back(all[i * all.size() / count]);
    return looks;
}

std::vector<Vector3d> MovedThings::normalsOf(std::size_t position, const Fresh& fresh)
{
    const SubmapView view = mapper_.viewOf(graph_.vertices[position].id);
    const Pose T_submap_world = poseOf(position).inverse();
    std::vector<MapPoint> points;
    for (const std::uint64_t key : fresh)
    {
        const Voxel& voxel = voxels_.at(key);
        const Vector3d p = T_submap_world * Vector3d(voxel.point.cast<double>());
        const bool seen_here = voxel.last_return.first == position;
        const std::size_t scan = seen_here ? voxel.last_return.second : 0;
        const Vector3d seen_from = view.submap->scans[scan].T_submap_imu.p;
        points.push_back({p, FeatureKind::Any, (seen_from - p).normalized()});
    }
    std::vector<Vector3d> normals = SubmapRegistration(*view.map, executor_).normalsOf(points);
    for (Vector3d& normal : normals) normal = poseOf(position).R * normal;
    return normals;
}

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

/* map.ply keeps the first point at a place alone; the submaps tell of those that came later. */
void MovedThings::findLastReturns()
{
    for (std::size_t position = 0; position < graph_.vertices.size(); position++)
    {
        const auto submap = mapper_.submap(graph_.vertices[position].id);
        for (const SubmapPoint& p : submap->points)
        {
            const Vector3d p_world = poseOf(position) * Vector3d(p.position.cast<double>());
            const auto found = voxels_.find(voxelKey(p_world, kInverseVoxel));
            if (found == voxels_.end()) continue;
            found->second.last_return = std::max(found->second.last_return, {position, p.scan});
        }
    }
}

void MovedThings::spread()
{
    std::vector<std::uint64_t> front;
    for (const auto& [key, voxel] : voxels_)
        if (voxel.gone) front.push_back(key);
    for (int step = 0; step < kSpread; step++)
    {
        std::vector<std::uint64_t> next;
        for (const std::uint64_t key : front)
            forAround(
                key,
                [&](std::uint64_t around)
                {
                    const auto found = voxels_.find(around);
                    if (found == voxels_.end() || found->second.gone) return;
                    if (countAfter(found->second.past, found->second.last_return) == 0) return;
                    found->second.gone = true;
                    next.push_back(around);
                });
        front.swap(next);
    }
}

bool MovedThings::haveLeft(const Vector3d& p_world) const
{
    const auto found = voxels_.find(voxelKey(p_world, kInverseVoxel));
    return found != voxels_.end() && found->second.gone;
}
}  // namespace taut
