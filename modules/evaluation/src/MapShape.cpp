#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "taut/evaluation/MapScores.h"
#include "taut/evaluation/PointGrid.h"

namespace taut
{
namespace
{
constexpr std::size_t kCells = 64;  // of a chunk

// Walls
constexpr std::size_t kWallPoints = 20;  // of a window, at least
constexpr double kWallSpread = 0.07;     // [m], in both directions along the wall, at least
constexpr double kFlat = 0.5;            // deviation along the normal, of the smaller one along
constexpr double kCurved = 0.25;         // of the variance: what a quadratic may explain of a plane

// Entropy
constexpr std::size_t kEntropyPoints = 15;     // within the radius, at least
constexpr std::size_t kMostQueries = 500'000;  // of the points, evenly
constexpr double kLeastVariance = 1e-8;        // [m^2]: a tenth of a millimetre

struct Moments
{
    std::size_t count = 0;
    Vector3d mean = Vector3d::Zero();
    Matrix3d scatter = Matrix3d::Zero();  // about the mean [m^2]

    explicit Moments(const std::vector<Vector3d>& points) : count(points.size())
    {
        for (const Vector3d& p : points) mean += p;
        mean /= static_cast<double>(count);
        for (const Vector3d& p : points) scatter += (p - mean) * (p - mean).transpose();
    }
};

void collect(
    const PointGrid& grid, const PointGrid::Ranges& ranges, const Vector3d& centre, double radius,
    std::vector<Vector3d>& points)
{
    points.clear();
    for (const auto& [begin, end] : ranges)
        for (std::size_t i = begin; i < end; i++)
        {
            const Vector3d p = grid.points()[i].cast<double>() - centre;
            if (p.squaredNorm() <= radius * radius) points.push_back(p);
        }
}

/** Share of the variance along the normal that depends on the place along the wall as a quadratic:
 * a wall that is thick has none, a corner or a pipe has. */
double curvedShare(const std::vector<Vector3d>& points, const Moments& m, const Matrix3d& axes)
{
    using Vector6d = Eigen::Matrix<double, 6, 1>;
    Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
    Vector6d g = Vector6d::Zero();
    double all = 0;
    for (const Vector3d& p : points)
    {
        const Vector3d q = axes.transpose() * (p - m.mean) / (WallThickness::kWindow / 2);
        Vector6d J;
        J << 1, q[1], q[2], q[1] * q[1], q[1] * q[2], q[2] * q[2];
        H += J * J.transpose();
        g += J * q[0];
        all += q[0] * q[0];
    }
    return all > 0 ? g.dot(H.ldlt().solve(g)) / all : 0;
}

/** Deviation along the normal; below zero where the window is no plane. */
double thicknessOf(const std::vector<Vector3d>& points)
{
    const Moments m(points);
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(m.scatter);
    const auto n = static_cast<double>(m.count);
    const Vector3d variance = eigen.eigenvalues().cwiseMax(0.0) / (n - 1);  // increasing
    if (variance[1] < square(kWallSpread) || variance[0] > square(kFlat) * variance[1]) return -1;
    if (curvedShare(points, m, eigen.eigenvectors()) > kCurved) return -1;
    return std::sqrt(std::max(0.0, eigen.eigenvalues()[0]) / (n - 3));  // a plane takes three
}
}  // namespace

WallThickness wallThickness(const std::vector<Eigen::Vector3f>& map, Executor& executor)
{
    constexpr double kRadius = WallThickness::kWindow / 2;
    const PointGrid grid(map, WallThickness::kWindow);
    struct Part
    {
        std::size_t windows = 0;
        std::vector<double> thickness;
    };
    std::vector<Part> parts(Executor::chunks(grid.cells(), kCells));
    executor.forChunks(
        grid.cells(), kCells,
        [&](std::size_t chunk, std::size_t first, std::size_t last)
        {
            std::vector<Vector3d> points;
            for (std::size_t cell = first; cell < last; cell++)
            {
                // About the middle of the points, so that no wall is cut by the side of a cell.
                const auto [begin, end] = grid.pointsOf(cell);
                Vector3d centre = Vector3d::Zero();
                for (std::size_t i = begin; i < end; i++)
                    centre += grid.points()[i].cast<double>() / static_cast<double>(end - begin);
                collect(grid, grid.around(centre), centre, kRadius, points);
                if (points.size() < kWallPoints) continue;
                parts[chunk].windows++;
                const double thickness = thicknessOf(points);
                if (thickness >= 0) parts[chunk].thickness.push_back(thickness);
            }
        });
    WallThickness out;
    std::vector<double> all;
    for (const Part& part : parts)
    {
        out.windows += part.windows;
        all.insert(all.end(), part.thickness.begin(), part.thickness.end());
    }
    out.planes = all.size();
    out.median = quantileOf(all, 0.5);
    out.percentile90 = quantileOf(all, 0.9);
    return out;
}

MapEntropy meanMapEntropy(const std::vector<Eigen::Vector3f>& map, Executor& executor)
{
    const PointGrid grid(map, MapEntropy::kRadius);
    const std::size_t stride = 1 + map.size() / kMostQueries;
    std::vector<MapEntropy> parts(Executor::chunks(grid.cells(), kCells));
    const double constant = 1.5 * std::log(2 * M_PI * std::exp(1.0));
    executor.forChunks(
        grid.cells(), kCells,
        [&](std::size_t chunk, std::size_t first, std::size_t last)
        {
            std::vector<Vector3d> points;
            for (std::size_t cell = first; cell < last; cell++)
            {
                const auto [begin, end] = grid.pointsOf(cell);
                const PointGrid::Ranges ranges = grid.around(grid.points()[begin].cast<double>());
                for (std::size_t i = (begin + stride - 1) / stride * stride; i < end; i += stride)
                {
                    parts[chunk].points++;
                    const Vector3d centre = grid.points()[i].cast<double>();
                    collect(grid, ranges, centre, MapEntropy::kRadius, points);
                    if (points.size() < kEntropyPoints) continue;
                    const Moments m(points);
                    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(
                        m.scatter, Eigen::EigenvaluesOnly);
                    const Vector3d variance =
                        (eigen.eigenvalues() / static_cast<double>(m.count - 1))
                            .cwiseMax(kLeastVariance);
                    parts[chunk].counted++;
                    parts[chunk].mean += constant + 0.5 * variance.array().log().sum();
                }
            }
        });
    MapEntropy out;
    for (const MapEntropy& part : parts)
    {
        out.points += part.points;
        out.counted += part.counted;
        out.mean += part.mean;
    }
    if (out.counted > 0) out.mean /= static_cast<double>(out.counted);
    return out;
}
}  // namespace taut
