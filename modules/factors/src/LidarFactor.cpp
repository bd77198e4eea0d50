#include "taut/factors/LidarFactor.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "taut/factors/SampledPath.h"

namespace taut
{
namespace
{
constexpr std::size_t kChunk = 3;  // intervals between nodes
constexpr std::size_t kPointChunk = 512;
constexpr Duration kNodeSpacing = 5'000'000;  // [ns] between exact derivatives of the path
constexpr int kPathSize = 2 * NavState::kSize;

/** Rows that project a difference on what the surface measures: n^T of a plane; two unit vectors
 * across a line, which span the same as the paper's n^ . */
Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor, 2, 3> projection(const Correspondence& c)
{
    Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor, 2, 3> P;
    if (c.surface == Surface::Plane)
    {
        P.resize(1, 3);
        P = c.direction.transpose();
    }
    else
    {
        const Vector3d u = c.direction.unitOrthogonal();
        P.resize(2, 3);
        P.row(0) = u.transpose();
        P.row(1) = c.direction.cross(u).transpose();
    }
    return P;
}

using PoseRow = Eigen::Matrix<double, 6, 1>;

/** Derivative of n^T y by (p, theta) of the pose that takes x to y: dy = dp - R [x]^ dtheta. */
PoseRow poseDerivative(const Vector3d& n, const Vector3d& x, const Pose& pose)
{
    PoseRow J;
    J << n, x.cross(pose.R.transpose() * n);
    return J;
}
}  // namespace

/** Noise of a residual and the kernel that judges it. */
struct LidarFactor::Noise
{
    double variance;  //!< [m^2]
    double widening;  //!< of the kernel's argument, at least 1
    const RobustKernel& kernel;

    double rho(double r2) const { return widening * kernel.rho(r2 / (widening * variance)); }
    double weight(double r2) const { return kernel.weight(r2 / (widening * variance)); }
};

LidarFactor::Noise LidarFactor::noiseOf(std::size_t i, double balance) const
{
    const double sigma = correspondences_[i].sigma;
    const double variance = balance * balance * (noise_.sigma * noise_.sigma + sigma * sigma);
    return {variance, surprise_ * (1 + predicted_variance_[i] / variance), noise_.kernel};
}

/** Normal equations of the points between two nodes of the path, in the poses at both: 6 x 6 blocks
 * and 6 rows each. */
struct LidarFactor::Interval
{
    using Block = Eigen::Matrix<double, 6, 6>;
    using Row = PoseRow;
    Block H_begin = Block::Zero(), H_both = Block::Zero(), H_end = Block::Zero();
    Row g_begin = Row::Zero(), g_end = Row::Zero();
    double cost = 0;

    /** A row of a residual r with weight w at a share of the interval: the derivative J by the pose
     * there is shared between both nodes. */
    void add(const Row& J, double r, double w, double share)
    {
        const Row wJ = w * J;
        const Block wJJ = wJ * J.transpose();
        H_begin += (1 - share) * (1 - share) * wJJ;
        H_both += share * (1 - share) * wJJ;
        H_end += share * share * wJJ;
        g_begin += (1 - share) * r * wJ;
        g_end += share * r * wJ;
    }
};

LidarFactor::LidarFactor(
    const Features& features, const LidarNoiseConfig& noise, Executor& executor)
    : features_(features), noise_(noise), executor_(executor)
{
}

void LidarFactor::setCorrespondences(
    const std::vector<Correspondence>& correspondences, const SweepPath& path,
    const PoseCovariance& predicted, double balance)
{
    correspondences_ = correspondences;
    predicted_variance_.assign(correspondences.size(), 0);
    const Placed& at = placed(path);
    executor_.forChunks(
        correspondences.size(), kPointChunk,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; i++)
            {
                if (correspondences[i].surface == Surface::None) continue;
                const Vector3d x = features_.points[i].position.cast<double>();
                const auto P = projection(correspondences[i]);
                for (int k = 0; k < P.rows(); k++)
                {
                    const PoseRow J = poseDerivative(P.row(k), x, at.poses[i]);
                    predicted_variance_[i] += J.dot(predicted * J) / static_cast<double>(P.rows());
                }
            }
        });
    measureSurprise(path, balance);
}

void LidarFactor::measureSurprise(const SweepPath& path, double balance)
{
    surprise_ = 1;  // of the residuals alone
    std::vector<double> e2;
    e2.reserve(correspondences_.size());
    forResiduals(
        path, balance,
        [&](double r2, const Noise& noise, int rows)
        { e2.push_back(r2 / (noise.widening * noise.variance * rows)); });
    if (e2.empty()) return;
    const auto middle = e2.begin() + static_cast<std::ptrdiff_t>(e2.size() / 2);
    std::nth_element(e2.begin(), middle, e2.end());
    constexpr double kMedianOfChi2 = 0.455;  // one degree of freedom
    surprise_ = std::max(1.0, *middle / kMedianOfChi2);
}

const LidarFactor::Placed& LidarFactor::placed(const SweepPath& path) const
{
    const std::size_t n = features_.points.size();
    if (n == 0 || placed_.revision == path.revision()) return placed_;
    const SampledPath sampled(path, timeOf(0), timeOf(n - 1));
    placed_.poses.resize(n);
    placed_.points.resize(n);
    executor_.forChunks(
        n, kPointChunk,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; i++)
            {
                placed_.poses[i] = sampled.poseAt(timeOf(i));
                placed_.points[i] =
                    placed_.poses[i] * Vector3d(features_.points[i].position.cast<double>());
            }
        });
    placed_.revision = path.revision();
    return placed_;
}

LidarFactor::Interval LidarFactor::linearizeInterval(
    const Placed& at, double balance, Time begin) const
{
    Interval out;
    const auto first = std::lower_bound(
        features_.points.begin(), features_.points.end(), begin,
        [&](const Feature& f, Time t) { return features_.stamp + f.offset < t; });
    for (auto i = static_cast<std::size_t>(first - features_.points.begin());
         i < features_.points.size() && timeOf(i) < begin + kNodeSpacing; i++)
    {
        const Correspondence& c = correspondences_[i];
        if (c.surface == Surface::None) continue;
        const Vector3d x = features_.points[i].position.cast<double>();
        const auto P = projection(c);
        const Vector3d d = at.points[i] - c.point;
        double r2 = 0;
        for (int k = 0; k < P.rows(); k++) r2 += square(P.row(k).dot(d));

        const Noise noise = noiseOf(i, balance);
        const double w = noise.weight(r2) / noise.variance;
        out.cost += 0.5 * noise.rho(r2);

        const double share =
            static_cast<double>(timeOf(i) - begin) / static_cast<double>(kNodeSpacing);
        for (int k = 0; k < P.rows(); k++)
            out.add(poseDerivative(P.row(k), x, at.poses[i]), P.row(k).dot(d), w, share);
    }
    return out;
}

double LidarFactor::linearize(
    const SweepPath& path, double balance, ProblemMatrix& hessian, ProblemVector& gradient) const
{
    if (features_.points.empty()) return 0;
    const Time begin = timeOf(0);
    const auto count =
        static_cast<std::size_t>((timeOf(features_.points.size() - 1) - begin) / kNodeSpacing + 1);
    const Placed& at = placed(path);
    std::vector<Interval> intervals(count);
    Eigen::MatrixXd J(6 * (count + 1), kPathSize);  // derivative of the pose at each node
    executor_.forChunks(
        count + 1, kChunk,
        [&](std::size_t, std::size_t first, std::size_t last)
        {
            std::size_t hint = 0;
            PathJacobian at_node;
            for (std::size_t i = first; i < last; i++)
            {
                const Time node = begin + static_cast<Duration>(i) * kNodeSpacing;
                path.poseAt(node, hint, at_node);
                J.middleRows<6>(static_cast<Eigen::Index>(6 * i)) = at_node;
                if (i < count) intervals[i] = linearizeInterval(at, balance, node);
            }
        });

    Eigen::MatrixXd HJ = Eigen::MatrixXd::Zero(J.rows(), kPathSize);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(J.rows());
    double cost = 0;
    for (std::size_t i = 0; i < count; i++)
    {
        const auto row = static_cast<Eigen::Index>(6 * i);
        const Interval& in = intervals[i];
        HJ.middleRows<6>(row) +=
            in.H_begin * J.middleRows<6>(row) + in.H_both * J.middleRows<6>(row + 6);
        HJ.middleRows<6>(row + 6) +=
            in.H_both * J.middleRows<6>(row) + in.H_end * J.middleRows<6>(row + 6);
        g.segment<6>(row) += in.g_begin;
        g.segment<6>(row + 6) += in.g_end;
        cost += in.cost;
    }
    const ProblemMatrix H = J.transpose() * HJ;
    hessian += 0.5 * (H + H.transpose());  // the products round both halves differently
    gradient.noalias() += J.transpose() * g;
    return cost;
}

template <class Body>
void LidarFactor::forResiduals(const SweepPath& path, double balance, const Body& body) const
{
    const Placed& at = placed(path);
    for (std::size_t i = 0; i < correspondences_.size(); i++)
    {
        const Correspondence& c = correspondences_[i];
        if (c.surface == Surface::None) continue;
        const Vector3d d = at.points[i] - c.point;
        const double along = c.direction.dot(d);
        const double r2 =
            c.surface == Surface::Plane ? along * along : d.squaredNorm() - along * along;
        body(r2, noiseOf(i, balance), c.surface == Surface::Plane ? 1 : 2);
    }
}

double LidarFactor::cost(const SweepPath& path, double balance) const
{
    double sum = 0;
    forResiduals(
        path, balance, [&](double r2, const Noise& noise, int) { sum += 0.5 * noise.rho(r2); });
    return sum;
}

LidarFit LidarFactor::fit(const SweepPath& path, double balance) const
{
    LidarFit f;
    forResiduals(
        path, balance,
        [&](double r2, const Noise& noise, int rows)
        {
            const double w = noise.weight(r2);
            f.count++;
            f.chi2 += w * r2 / noise.variance;
            f.weights += w * rows;
        });
    return f;
}

double LidarFactor::explained(const SweepPath& path) const
{
    double sum = 0;
    forResiduals(
        path, 1,
        [&](double r2, const Noise& noise, int)
        { sum += noise.kernel.weight(r2 / noise.variance); });
    return sum;
}
}  // namespace taut
