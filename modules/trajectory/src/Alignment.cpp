#include "taut/trajectory/Alignment.h"

#include <Eigen/SVD>
#include <cmath>
#include <stdexcept>

#include "taut/trajectory/Interpolation.h"

namespace taut
{
namespace
{
constexpr double kMinSpread = 1e-3;  // [m], standard deviation

/** First and second moments of the positions. */
struct Moments
{
    Vector3d mean_truth = Vector3d::Zero(), mean_estimate = Vector3d::Zero();
    Matrix3d cross = Matrix3d::Zero();  // E[truth estimate^T], centred [m^2]
    Matrix3d truth = Matrix3d::Zero();  // E[truth truth^T], centred [m^2]
};

Moments momentsOf(const PosePairs& pairs)
{
    Moments m;
    const double weight = 1.0 / static_cast<double>(pairs.size());
    for (const PosePair& pair : pairs)
    {
        m.mean_truth += weight * pair.truth.p;
        m.mean_estimate += weight * pair.estimate.p;
    }
    for (const PosePair& pair : pairs)
    {
        const Vector3d d = pair.truth.p - m.mean_truth;
        m.cross += weight * d * (pair.estimate.p - m.mean_estimate).transpose();
        m.truth += weight * d * d.transpose();
    }
    return m;
}

void requireSpread(double variance, const std::string& what)
{
    if (!(variance > kMinSpread * kMinSpread))
        throw std::runtime_error(
            "the alignment is not determined: the positions spread by less than 1 mm " + what);
}

Matrix3d rotationOf(const Moments& m)
{
    const Eigen::JacobiSVD<Matrix3d> svd(m.cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
    requireSpread(
        Eigen::JacobiSVD<Matrix3d>(m.truth).singularValues()[1], "off a line; try yaw or none");
    const Matrix3d& U = svd.matrixU();
    const Matrix3d& V = svd.matrixV();
    Vector3d signs = Vector3d::Ones();
    if (U.determinant() * V.determinant() < 0) signs[2] = -1;  // a rotation, not a reflection
    return U * signs.asDiagonal() * V.transpose();
}

Matrix3d yawOf(const Moments& m)
{
    requireSpread(m.truth(0, 0) + m.truth(1, 1), "in the horizontal plane; try none");
    const double sine = m.cross(1, 0) - m.cross(0, 1), cosine = m.cross(0, 0) + m.cross(1, 1);
    return expSO3({0, 0, std::atan2(sine, cosine)});
}
}  // namespace

std::string nameOf(Alignment alignment)
{
    switch (alignment)
    {
        case Alignment::SE3:
            return "se3";
        case Alignment::Yaw:
            return "yaw";
        case Alignment::None:
            return "none";
        case Alignment::Given:
            return "given";
    }
    throw std::invalid_argument("not an alignment");
}

Alignment alignmentOf(const std::string& name)
{
    for (const Alignment a : {Alignment::SE3, Alignment::Yaw, Alignment::None})
        if (nameOf(a) == name) return a;
    throw std::invalid_argument("'" + name + "' is not an alignment (se3, yaw, none)");
}

bool isSparser(const Trajectory& truth, const Trajectory& estimate)
{
    return estimate.size() > 1 && medianSpacing(truth) > medianSpacing(estimate) * 11 / 10;
}

PosePairs pairPoses(
    const Trajectory& truth, const Trajectory& estimate, Duration max_truth_gap,
    Duration max_estimate_gap)
{
    requireIncreasing(estimate);
    const TrajectoryInterpolator truth_at(truth, max_truth_gap);
    PosePairs pairs;
    if (isSparser(truth, estimate))
    {
        const TrajectoryInterpolator estimate_at(estimate, max_estimate_gap);
        for (const StampedPose& pose : truth)
            if (const auto T = estimate_at.at(pose.t))
                pairs.push_back({pose.t, pose.T_world_imu, *T});
        return pairs;
    }
    for (const StampedPose& pose : estimate)
        if (const auto T = truth_at.at(pose.t)) pairs.push_back({pose.t, *T, pose.T_world_imu});
    return pairs;
}

Pose align(const PosePairs& pairs, Alignment alignment)
{
    if (alignment == Alignment::Given)
        throw std::invalid_argument("a given alignment is not found again");
    if (alignment == Alignment::None) return {};
    if (pairs.empty()) throw std::runtime_error("no poses to align");
    const Moments m = momentsOf(pairs);
    const Matrix3d R = alignment == Alignment::SE3 ? rotationOf(m) : yawOf(m);
    return {R, m.mean_truth - R * m.mean_estimate};
}
}  // namespace taut
