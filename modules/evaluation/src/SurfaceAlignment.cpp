#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "taut/evaluation/MapScores.h"
#include "taut/evaluation/PointGrid.h"

namespace taut
{
namespace
{
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kCell = 0.3;  // [m], one point in each
constexpr std::size_t kMostPoints = 20'000;
constexpr double kFirstWidth = 0.5, kLastWidth = 0.1;  // of the kernel [m]
constexpr double kReach = 2;                           // [m]; what is further away has no partner
constexpr double kNear = 0.5;                          // [m]
constexpr int kMostIterations = 60;
constexpr double kStill = 1e-6;  // [m], of a step
constexpr double kShown = 1e-3;  // information of a direction, of the largest

/** Points spread evenly over the map. */
std::vector<Vector3d> thinned(const std::vector<Eigen::Vector3f>& map)
{
    const PointGrid grid(map, kCell);
    const std::size_t stride = 1 + grid.cells() / kMostPoints;
    std::vector<Vector3d> points;
    for (std::size_t i = 0; i < grid.cells(); i += stride)
        points.push_back(grid.points()[grid.pointsOf(i).first].cast<double>());
    return points;
}

/** Normal equations of a step of the pose: a turn about `centre`, scaled to move points by about
 * its size in metres, and a shift. */
struct Normal
{
    Matrix6d H = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
    std::size_t near = 0;
};

Normal linearise(
    const std::vector<Vector3d>& points, const TrueSurface& truth, const Pose& T,
    const Vector3d& centre, double lever, double width, std::vector<std::uint32_t>& guesses)
{
    Normal normal;
    for (std::size_t i = 0; i < points.size(); i++)
    {
        const Vector3d p = T * points[i];
        const TrueSurface::Nearest nearest = truth.nearest(p, kReach, guesses[i]);
        if (nearest.element == TrueSurface::Nearest::kNone) continue;
        guesses[i] = nearest.element;
        if (nearest.distance < kNear) normal.near++;
        const Vector3d n = truth.normalOf(nearest.element);
        const double r = n.dot(p - nearest.point);
        const double weight = square(square(width) / (square(width) + square(nearest.distance)));
        Vector6d J;
        J << (p - centre).cross(n) / lever, n;
        normal.H += weight * J * J.transpose();
        normal.g += weight * J * r;
    }
    return normal;
}
}  // namespace

SurfaceAlignment alignToSurface(
    const std::vector<Eigen::Vector3f>& map, const TrueSurface& truth, Alignment alignment)
{
    if (alignment != Alignment::SE3 && alignment != Alignment::Yaw)
        throw std::invalid_argument("a map is laid on its truth by se3 or yaw");
    const std::vector<Vector3d> points = thinned(map);
    if (points.empty()) throw std::runtime_error("the map is empty");
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& p : points) mean += p / static_cast<double>(points.size());
    double spread = 0;
    for (const Vector3d& p : points) spread += (p - mean).squaredNorm();
    const double lever = std::max(0.1, std::sqrt(spread / static_cast<double>(points.size())));

    Vector6d free = Vector6d::Ones();
    if (alignment == Alignment::Yaw) free.head<2>().setZero();
    SurfaceAlignment result;
    std::vector<std::uint32_t> guesses(points.size(), TrueSurface::Nearest::kNone);
    double width = kFirstWidth;
    for (; result.iterations < kMostIterations; result.iterations++)
    {
        const Vector3d centre = result.T_truth_map * mean;
        Normal normal = linearise(points, truth, result.T_truth_map, centre, lever, width, guesses);
        result.near_share = static_cast<double>(normal.near) / static_cast<double>(points.size());
        normal.H = free.asDiagonal() * normal.H * free.asDiagonal();
        normal.g = free.asDiagonal() * normal.g;
        const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(normal.H);
        const double least = kShown * eigen.eigenvalues()[5];
        Vector6d step = Vector6d::Zero();
        result.directions = 0;
        for (int i = 0; i < 6; i++)
        {
            if (!(eigen.eigenvalues()[i] > least)) continue;
            const Vector6d direction = eigen.eigenvectors().col(i);
            step -= direction * (direction.dot(normal.g) / eigen.eigenvalues()[i]);
            result.directions++;
        }
        const Matrix3d turn = expSO3(step.head<3>() / lever);
        result.T_truth_map =
            Pose{turn, centre + step.tail<3>() - turn * centre} * result.T_truth_map;
        result.T_truth_map.R = normalizedRotation(result.T_truth_map.R);
        if (step.norm() < kStill && width <= kLastWidth) break;
        width = std::max(kLastWidth, 0.8 * width);
    }
    return result;
}
}  // namespace taut
