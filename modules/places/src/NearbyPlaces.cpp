#include "taut/places/NearbyPlaces.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

IMPLEMENTS_MRPT_OBJECT(NearbyPlaces, taut::PlaceRecognizer, taut)

namespace taut
{
namespace
{
constexpr double kWayStep = 1;  // [m] between the points that are kept of a way

double largestDeviation(const Matrix6d& covariance)
{
    const Matrix3d position = covariance.topLeftCorner<3, 3>();
    return std::sqrt(std::max(
        0.0, Eigen::SelfAdjointEigenSolver<Matrix3d>(position, Eigen::EigenvaluesOnly)
                 .eigenvalues()
                 .maxCoeff()));
}
}  // namespace

void NearbyPlaces::configure(ConfigSection& s)
{
    s.key("sigmas", config.sigmas, kPositive, "of the graph's uncertainty that are searched");
    s.key("overlap", config.overlap, kPositive, "reaches that two paths may be apart");
    s.key("min_way", config.min_way, kPositive, "reaches on the way between two submaps, at least");
    s.key("max_distance", config.max_distance, kPositive, "m, further nobody is looked for");
    s.key("most", config.most, {1, 100}, "candidates of a submap");
}

void NearbyPlaces::add(const Submap& submap)
{
    Place place{submap.id, submap.path_begin, submap.path_end, submap.reach, {}};
    for (const SubmapScan& scan : submap.scans)
        if (place.way.empty() || (scan.T_submap_imu.p - place.way.back()).norm() > kWayStep)
            place.way.push_back(scan.T_submap_imu.p);
    places_.push_back(std::move(place));
}

double NearbyPlaces::distance(const Place& from, const Place& to, const Pose& T_from_to)
{
    double nearest = 1e300;
    for (const Vector3d& q : to.way)
    {
        const Vector3d moved = T_from_to * q;
        for (const Vector3d& p : from.way) nearest = std::min(nearest, (p - moved).norm());
    }
    return nearest;
}

std::vector<LoopCandidate> NearbyPlaces::candidates(
    VertexId id, const PlaceKnowledge& knowledge) const
{
    const auto find = [&](VertexId wanted)
    {
        return std::lower_bound(
            places_.begin(), places_.end(), wanted,
            [](const Place& p, VertexId i) { return p.id < i; });
    };
    const auto to = find(id);
    const Pose T_world_to = knowledge.pose(id);
    std::vector<std::pair<double, LoopCandidate>> ranked;
    for (auto from = places_.begin(); from != to; ++from)
    {
        const double reach = std::max(from->reach, to->reach);
        if (to->path_begin - from->path_end < config.min_way * reach) continue;
        const Pose T_from_to = knowledge.pose(from->id).inverse() * T_world_to;
        const double apart = distance(*from, *to, T_from_to);
        if (apart > config.max_distance) continue;
        const std::optional<Matrix6d> covariance = knowledge.covariance(from->id, id);
        if (!covariance) continue;
        const double beyond = apart - config.overlap * reach;
        if (beyond > config.sigmas * largestDeviation(*covariance)) continue;
        ranked.push_back({apart, {from->id, id, T_from_to, *covariance, "estimate"}});
    }
    std::stable_sort(
        ranked.begin(), ranked.end(),
        [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<LoopCandidate> best;
    for (const auto& [apart, candidate] : ranked)
        if (best.size() < static_cast<std::size_t>(config.most)) best.push_back(candidate);
    return best;
}
}  // namespace taut
