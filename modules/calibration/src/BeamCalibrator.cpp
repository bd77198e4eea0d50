#include "taut/calibration/BeamCalibrator.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "taut/core/Voxel.h"

namespace taut
{
namespace
{
constexpr double kLargestVoxel = 1.6, kSmallestVoxel = 0.2;  // [m]
constexpr std::size_t kFewestPoints = 30;                    // of a plane
constexpr int kFewestRings = 3;     // two beams alone tell a tilt of the plane
constexpr double kThickest = 0.08;  // [m] standard deviation: more than beams that err make
constexpr double kFlat = 25;        // times more variance within a plane than across
constexpr double kKernel = 0.1;     // [m] width of Geman and McClure's
constexpr double kShown = 0.5;      // of the prior's deviation: less is told by the data
constexpr double kOnAxis = 0.01;    // of the range: beams so near to the axis have no azimuth

struct Plane
{
    Vector3d middle, normal;
    bool fits = false;
};

template <class Iterator>
Plane planeOf(Iterator begin, Iterator end)
{
    Plane plane;
    const double share = 1 / static_cast<double>(end - begin);
    plane.middle.setZero();
    for (auto p = begin; p != end; ++p) plane.middle += share * p->point;
    Matrix3d covariance = Matrix3d::Zero();
    for (auto p = begin; p != end; ++p)
    {
        const Vector3d d = p->point - plane.middle;
        covariance += share * d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance);
    plane.normal = eigen.eigenvectors().col(0);
    const Vector3d& spread = eigen.eigenvalues();
    plane.fits = spread[0] < square(kThickest) && spread[1] > kFlat * spread[0];
    return plane;
}
}  // namespace

BeamCalibrator::BeamCalibrator(
    const BeamCalibrationConfig& config, int rings, BeamCorrections applied)
    : config_(config), rings_(rings), applied_(std::move(applied))
{
    const auto n = static_cast<std::size_t>(rings);
    if (applied_.empty()) applied_ = {std::vector<double>(n, 0), std::vector<double>(n, 0)};
    for (Equations& e : halves_)
    {
        e.hessian = Eigen::MatrixXd::Zero(2 * rings, 2 * rings);
        e.gradient = Eigen::VectorXd::Zero(2 * rings);
    }
}

void BeamCalibrator::add(const Sweep& sweep, const NavState& end)
{
    if (window_.empty()) window_begin_ = sweep.scan.stamp;
    // Each point three times: where it is, and with either of its errors. Undistortion is affine in
    // the point, so that the differences are the derivatives in the world.
    Sweep moved = sweep;
    moved.scan.points.clear();
    std::vector<std::uint16_t> rings;
    const Pose T_lidar_imu = sweep.T_imu_lidar.inverse();
    const std::size_t stride = sweep.scan.points.size() / config_.points + 1;
    for (std::size_t i = 0; i < sweep.scan.points.size(); i += stride)
    {
        const LidarPoint& p = sweep.scan.points[i];
        const Vector3d in_lidar = T_lidar_imu * Vector3d(p.position.cast<double>());
        if (p.ring >= rings_ || std::hypot(in_lidar.x(), in_lidar.y()) < kOnAxis * in_lidar.norm())
            continue;
        const BeamDerivative d = beamDerivative(in_lidar);
        rings.push_back(p.ring);
        moved.scan.points.push_back(p);
        for (const Vector3d& by : {d.by_range, d.by_elevation})
        {
            LidarPoint other = p;
            other.position += (sweep.T_imu_lidar.R * by).cast<float>();
            moved.scan.points.push_back(other);
        }
    }
    const std::vector<Vector3d> world = moved.undistorted(sweep.begin, end);
    for (std::size_t i = 0; i < rings.size(); i++)
        window_.push_back(
            {world[3 * i],
             {world[3 * i + 1] - world[3 * i], world[3 * i + 2] - world[3 * i]},
             rings[i]});
    if (toSeconds(sweep.scan.stamp - window_begin_) > config_.window) closeWindow();
}

void BeamCalibrator::closeWindow()
{
    std::map<std::uint64_t, std::pair<Vector3d, Points>> voxels;  // in a defined order
    for (const Observed& o : window_)
    {
        auto& [corner, points] = voxels[voxelKey(o.point, 1 / kLargestVoxel)];
        corner = kLargestVoxel * (o.point / kLargestVoxel).array().floor().matrix();
        points.push_back(o);
    }
    for (auto& [key, voxel] : voxels)
        addVoxel(voxel.second.begin(), voxel.second.end(), voxel.first, kLargestVoxel);
    window_.clear();
    windows_++;
}

/* The plane of a voxel, or those of its eight parts. */
void BeamCalibrator::addVoxel(
    Points::iterator begin, Points::iterator end, const Vector3d& corner, double edge)
{
    if (static_cast<std::size_t>(end - begin) < kFewestPoints) return;
    const Plane plane = planeOf(begin, end);
    if (plane.fits)
    {
        addPlane(begin, end, plane.middle, plane.normal);
        return;
    }
    const double half = edge / 2;
    if (half < kSmallestVoxel) return;
    for (int part = 0; part < 8; part++)
    {
        const Vector3d from = corner + half * Vector3d(part & 1, part >> 1 & 1, part >> 2);
        const auto inside = [&](const Observed& o) {
            return ((o.point - from).array() >= 0).all() && ((o.point - from).array() < half).all();
        };
        const auto middle = std::stable_partition(begin, end, inside);
        addVoxel(begin, middle, from, half);
        begin = middle;
    }
}

void BeamCalibrator::addPlane(
    const Points::iterator begin, const Points::iterator end, const Vector3d& middle,
    const Vector3d& normal)
{
    std::map<std::uint16_t, int> columns;  // of the rings that see it
    for (auto p = begin; p != end; ++p) columns.emplace(p->ring, 0);
    if (static_cast<int>(columns.size()) < kFewestRings) return;
    int n = 0;
    for (auto& [ring, column] : columns) column = 2 * n++;

    // Residual of a point: distance + derivative * errors of its beam + (1, u, v) * plane.
    const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
    Eigen::MatrixXd of_beams = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(3, 2 * n);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(2 * n);
    Matrix3d of_plane = 1e-9 * Matrix3d::Identity();
    Vector3d plane_gradient = Vector3d::Zero();
    Equations& half = halves_[windows_ % 2];
    for (auto p = begin; p != end; ++p)
    {
        const Vector3d d = p->point - middle;
        const double distance = normal.dot(d);
        const double weight =
            square(1 / (1 + square(distance / kKernel))) / square(config_.range_noise);
        const int column = columns.at(p->ring);
        const Eigen::Vector2d by_beam(
            normal.dot(p->derivative.by_elevation), normal.dot(p->derivative.by_range));
        const Vector3d by_plane(1, u.dot(d), v.dot(d));
        of_beams.block<2, 2>(column, column) += weight * by_beam * by_beam.transpose();
        mixed.block<3, 2>(0, column) += weight * by_plane * by_beam.transpose();
        gradient.segment<2>(column) += weight * distance * by_beam;
        of_plane += weight * by_plane * by_plane.transpose();
        plane_gradient += weight * distance * by_plane;
        half.cost += weight * square(distance);
        half.weight += weight;
    }
    const Eigen::LDLT<Matrix3d> plane(of_plane);
    const Eigen::MatrixXd hessian = of_beams - mixed.transpose() * plane.solve(mixed);
    gradient -= mixed.transpose() * plane.solve(plane_gradient);
    half.cost -= plane_gradient.dot(plane.solve(plane_gradient));
    for (const auto& [row_ring, row] : columns)
    {
        half.gradient.segment<2>(2 * row_ring) += gradient.segment<2>(row);
        for (const auto& [column_ring, column] : columns)
            half.hessian.block<2, 2>(2 * row_ring, 2 * column_ring) +=
                hessian.block<2, 2>(row, column);
    }
}

/* The errors that are left, in the order of the equations. The prior is of their sum with what is
 * applied. */
Eigen::VectorXd BeamCalibrator::solve(const Equations& equations) const
{
    Eigen::MatrixXd hessian = equations.hessian;
    Eigen::VectorXd gradient = equations.gradient;
    for (int r = 0; r < rings_; r++)
    {
        const auto ring = static_cast<std::size_t>(r);
        const Eigen::Vector2d information(
            1 / square(config_.elevation_prior), 1 / square(config_.range_prior));
        const Eigen::Vector2d applied(applied_.elevation[ring], applied_.range[ring]);
        hessian.diagonal().segment<2>(2 * r) += information;
        gradient.segment<2>(2 * r) += information.cwiseProduct(applied);
    }
    return -hessian.ldlt().solve(gradient);
}

std::vector<CalibratedBeam> BeamCalibrator::finish()
{
    if (!window_.empty()) closeWindow();
    Equations all = halves_[0];
    all.hessian += halves_[1].hessian;
    all.gradient += halves_[1].gradient;
    const Eigen::VectorXd errors = solve(all);
    const Eigen::VectorXd apart = solve(halves_[0]) - solve(halves_[1]);
    cost_before_ = halves_[0].cost + halves_[1].cost;
    weight_ = halves_[0].weight + halves_[1].weight;
    cost_after_ = cost_before_ + 2 * all.gradient.dot(errors) + errors.dot(all.hessian * errors);

    Eigen::MatrixXd with_prior = all.hessian;
    for (int r = 0; r < rings_; r++)
        with_prior.diagonal().segment<2>(2 * r) +=
            Eigen::Vector2d(1 / square(config_.elevation_prior), 1 / square(config_.range_prior));
    const Eigen::VectorXd sigmas = with_prior.ldlt()
                                       .solve(Eigen::MatrixXd::Identity(2 * rings_, 2 * rings_))
                                       .diagonal()
                                       .cwiseSqrt();
    std::vector<CalibratedBeam> beams;
    for (int r = 0; r < rings_; r++)
    {
        const auto ring = static_cast<std::size_t>(r);
        CalibratedBeam beam;
        beam.elevation = applied_.elevation[ring] + errors[2 * r];
        beam.range = applied_.range[ring] + errors[2 * r + 1];
        beam.elevation_sigma = std::max(sigmas[2 * r], std::abs(apart[2 * r]) / 2);
        beam.range_sigma = std::max(sigmas[2 * r + 1], std::abs(apart[2 * r + 1]) / 2);
        beam.elevation_shown = sigmas[2 * r] < kShown * config_.elevation_prior;
        beam.range_shown = sigmas[2 * r + 1] < kShown * config_.range_prior;
        beams.push_back(beam);
    }
    return beams;
}

double BeamCalibrator::thicknessBefore() const
{
    return weight_ > 0 ? std::sqrt(std::max(0.0, cost_before_) / weight_) : 0;
}

double BeamCalibrator::thicknessAfter() const
{
    return weight_ > 0 ? std::sqrt(std::max(0.0, cost_after_) / weight_) : 0;
}
}  // namespace taut
