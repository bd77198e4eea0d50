#include "taut/slam/LoopScores.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "taut/core/PoseGraph.h"
#include "taut/graph/G2oFile.h"
#include "taut/submaps/SubmapStore.h"

namespace taut
{
namespace
{
constexpr double kNear = 3;             // [m] a revisit
constexpr double kWrong = 0.05;         // [m]
constexpr double kWrongAngle = 0.0087;  // [rad]
constexpr double kDeviations = 3;
constexpr double kNeighbours = 1.5;  // reaches of the way, on which submaps overlap as they follow

/** What is needed of a submap. */
struct Place
{
    Pose T_world_submap;        // true
    Vector3d middle;            // of the way, submap frame
    std::vector<Vector3d> way;  // of the body, true, world frame
    double path_begin = 0, path_end = 0, reach = 0;
};

/** Where the submap truly is: where its scans fit the truth best, all together. */
std::optional<Place> placeOf(
    const Submap& submap, const std::function<std::optional<Pose>(Time)>& truth)
{
    Place place{{}, Vector3d::Zero(), {}, submap.path_begin, submap.path_end, submap.reach};
    Matrix3d rotations = Matrix3d::Zero();
    Vector3d middle_of_truth = Vector3d::Zero();
    double count = 0;
    for (const SubmapScan& scan : submap.scans)
    {
        const std::optional<Pose> pose = truth(scan.t);
        if (!pose) continue;
        count++;
        rotations += pose->R * scan.T_submap_imu.R.transpose();
        middle_of_truth += pose->p;
        place.middle += scan.T_submap_imu.p;
        if (place.way.empty() || (pose->p - place.way.back()).norm() > 0.5)
            place.way.push_back(pose->p);
    }
    if (count == 0) return {};
    place.middle /= count;
    place.T_world_submap.R = normalizedRotation(rotations / count);
    place.T_world_submap.p = middle_of_truth / count - place.T_world_submap.R * place.middle;
    return place;
}

bool isNear(const Place& a, const Place& b)
{
    for (const Vector3d& p : a.way)
        for (const Vector3d& q : b.way)
            if ((p - q).norm() < kNear) return true;
    return false;
}

/** Error of a loop in the directions that it shows. */
struct LoopError
{
    double position = 0, angle = 0, chi2 = 0;
    int directions = 0;
    bool beyond_deviations = false;
};

/** Told at a point of submap `to`: at its origin a small turn would count as a shift. */
LoopError errorOf(const RelativeEdge& loop, const Pose& T_true, const Vector3d& at)
{
    Matrix6d to_origin = Matrix6d::Identity();
    to_origin.topRightCorner<3, 3>() = hat(at);
    const ShownDirections directions =
        shownDirections(to_origin.transpose() * loop.information * to_origin);
    const Vector6d there = to_origin.inverse() * rightErrorTo(loop.T_from_to, T_true);
    const Eigen::VectorXd along = directions.basis.transpose() * there;
    const Vector6d shown = directions.basis * along;
    const Eigen::VectorXd chi2 = directions.information.cwiseProduct(along.cwiseAbs2());
    LoopError error;
    error.chi2 = chi2.sum();
    error.directions = static_cast<int>(chi2.size());
    error.beyond_deviations = (chi2.array() > square(kDeviations)).any();
    error.position = shown.head<3>().norm();
    error.angle = shown.tail<3>().norm();
    return error;
}
}  // namespace

LoopScores scoreLoops(
    const std::string& folder, const std::function<std::optional<Pose>(Time)>& truth)
{
    const PoseGraph graph = readG2o(folder + "/graph.g2o");
    const SubmapStore store(folder + "/submaps");
    std::map<VertexId, Place> places;
    for (const GraphVertex& vertex : graph.vertices)
        if (const auto place = placeOf(*store.at(vertex.id), truth))
            places.emplace(vertex.id, *place);

    LoopScores scores;
    std::set<VertexId> recognised;
    double chi2 = 0;
    int directions = 0;
    for (const RelativeEdge& edge : graph.relative_edges)
    {
        const auto from = places.find(edge.from), to = places.find(edge.to);
        if (edge.kind != EdgeKind::LoopClosure || from == places.end() || to == places.end())
            continue;
        const Pose T_true = from->second.T_world_submap.inverse() * to->second.T_world_submap;
        const LoopError error = errorOf(edge, T_true, to->second.middle);
        scores.loops++;
        scores.largest_error = std::max(scores.largest_error, error.position);
        chi2 += error.chi2;
        directions += error.directions;
        if (error.beyond_deviations && (error.position > kWrong || error.angle > kWrongAngle))
            scores.wrong++;
        else
            recognised.insert(edge.to);
    }
    scores.nees = directions > 0 ? chi2 / directions : 0;
    for (auto to = places.begin(); to != places.end(); ++to)
    {
        const bool is_revisit = std::any_of(
            places.begin(), to,
            [&](const auto& from)
            {
                const double reach = std::max(from.second.reach, to->second.reach);
                return to->second.path_begin - from.second.path_end > kNeighbours * reach &&
                       isNear(from.second, to->second);
            });
        if (!is_revisit) continue;
        scores.revisits++;
        scores.recognised += static_cast<int>(recognised.count(to->first));
    }
    return scores;
}
}  // namespace taut
