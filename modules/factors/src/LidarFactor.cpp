#include "taut/factors/LidarFactor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "taut/factors/SampledPath.h"

namespace taut
{
namespace
{
// Waking a thread takes as long as some thousand points do.
constexpr std::size_t kPointChunk = 2048;
constexpr Duration kNodeSpacing = 5'000'000;  // [ns] between exact derivatives of the path
constexpr int kPathSize = 2 * NavState::kSize;

/** Unit vectors that project a difference on what the surface measures: the normal of a plane; two
 * across a line, which span the same as the paper's n^ . */
struct Projection
{
    explicit Projection(const Correspondence& c)
    {
        if (c.surface == Surface::Plane)
        {
            rows[0] = c.direction;
            return;
        }
        rows[0] = c.direction.unitOrthogonal();
        rows[1] = c.direction.cross(rows[0]);
        count = 2;
    }

    std::array<Vector3d, 2> rows;
    std::size_t count = 1;
};

using PoseRow = Eigen::Matrix<double, 6, 1>;
using PoseBlock = Eigen::Matrix<double, 6, 6>;

/** Derivative of n^T y by the rotation of the pose that takes x to y: dy = dp - R [x]^ dtheta. */
Vector3d turnDerivative(const Vector3d& n, const Vector3d& x, const Pose& pose)
{
    return x.cross(pose.R.transpose() * n);
}
}  // namespace

/** Noise of a residual and the kernel that judges it. */
struct LidarFactor::Noise
{
    double variance;  //!< [m^2]
    double widened;   //!< [m^2] the variance by which the kernel judges, at least as large
    const RobustKernel& kernel;

    /** rho in units of the variance, and the weight. */
    RobustKernel::Judgement judge(double r2) const
    {
        const RobustKernel::Judgement j = kernel.judge(r2 / widened);
        return {j.rho * widened / variance, j.weight};
    }
};

LidarFactor::Noise LidarFactor::noiseOf(std::size_t i, double balance) const
{
    const double sigma = correspondences_[i].sigma;
    const double variance = balance * balance * (noise_.sigma * noise_.sigma + sigma * sigma);
    return {variance, excess_ * (variance + predicted_variance_[i]), noise_.kernel};
}

/** Normal equations of the points between two nodes of the path. The derivative J of a residual r
 * by the pose where it was seen is shared between the poses at both nodes, (1 - share) to share.
 * All that comes of it follows from sums of w share^k (J, r)(J, r)^T for k = 0, 1, 2. */
struct LidarFactor::Interval
{
    using Row = Eigen::Matrix<double, 8, 1>;     // J, r and a zero: whole pairs
    using Moment = Eigen::Matrix<double, 8, 6>;  // symmetric: what is above the pairs of its
                                                 // diagonal is left out
    std::array<Moment, 3> moments{Moment::Zero(), Moment::Zero(), Moment::Zero()};
    double cost = 0;

    /** A residual, ready to be added. */
    struct Weighted
    {
        Row row;
        double weight = 0, share = 0;
    };
    void add(const Weighted& in)
    {
        addProduct(in.weight * in.row, in.row, moments[0]);
        addProduct(in.weight * in.share * in.row, in.row, moments[1]);
        addProduct(in.weight * in.share * in.share * in.row, in.row, moments[2]);
    }

    template <int column = 0>
    static void addProduct(const Row& weighted, const Row& row, Moment& sum)
    {
        constexpr int below = 8 - column / 2 * 2;
        sum.col(column).template tail<below>() += weighted[column] * row.template tail<below>();
        if constexpr (column < 5) addProduct<column + 1>(weighted, row, sum);
    }

    PoseBlock hessian(int k) const
    {
        return moments[static_cast<std::size_t>(k)]
            .topLeftCorner<6, 6>()
            .selfadjointView<Eigen::Lower>();
    }
    PoseRow gradient(int k) const
    {
        return moments[static_cast<std::size_t>(k)].block<1, 6>(6, 0).transpose();
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
                const Projection P(correspondences[i]);
                for (std::size_t k = 0; k < P.count; k++)
                {
                    PoseRow J;
                    J << P.rows[k], turnDerivative(P.rows[k], x, at.poses[i]);
                    predicted_variance_[i] += J.dot(predicted * J) / static_cast<double>(P.count);
                }
            }
        });
    measureExcess(path, balance);
}

void LidarFactor::measureExcess(const SweepPath& path, double balance)
{
    excess_ = 1;  // of the residuals alone
    std::vector<double> e2;
    e2.reserve(correspondences_.size());
    forResiduals(
        path, balance,
        [&](double r2, const Noise& noise, int rows)
        { e2.push_back(r2 / (noise.widened * rows)); });
    if (e2.empty()) return;
    const auto middle = e2.begin() + static_cast<std::ptrdiff_t>(e2.size() / 2);
    std::nth_element(e2.begin(), middle, e2.end());
    constexpr double kMedianOfChi2 = 0.455;  // one degree of freedom
    excess_ = std::max(1.0, *middle / kMedianOfChi2);
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
    const auto firstAt = [&](Time time)
    {
        const auto first = std::lower_bound(
            features_.points.begin(), features_.points.end(), time,
            [&](const Feature& f, Time t) { return features_.stamp + f.offset < t; });
        return static_cast<std::size_t>(first - features_.points.begin());
    };
    const std::size_t first = firstAt(begin), last = firstAt(begin + kNodeSpacing);

    // A weight takes some divisions, one after the other. Were each residual added at once, a
    // processor could not look far enough ahead to begin with the next.
    Interval out;
    std::vector<Interval::Weighted> residuals;
    residuals.reserve(last - first);
    for (std::size_t i = first; i < last; i++)
    {
        const Correspondence& c = correspondences_[i];
        if (c.surface == Surface::None) continue;
        const Vector3d x = features_.points[i].position.cast<double>();
        const Projection P(c);
        const Vector3d d = at.points[i] - c.point;
        std::array<double, 2> r{};
        for (std::size_t k = 0; k < P.count; k++) r[k] = P.rows[k].dot(d);

        const Noise noise = noiseOf(i, balance);
        const RobustKernel::Judgement judged = noise.judge(square(r[0]) + square(r[1]));
        out.cost += 0.5 * judged.rho;

        const double weight = judged.weight / noise.variance;
        const double share =
            static_cast<double>(timeOf(i) - begin) / static_cast<double>(kNodeSpacing);
        for (std::size_t k = 0; k < P.count; k++)
        {
            Interval::Weighted& residual = residuals.emplace_back();
            residual.row << P.rows[k], turnDerivative(P.rows[k], x, at.poses[i]), r[k], 0;
            residual.weight = weight;
            residual.share = share;
        }
    }
    for (const Interval::Weighted& residual : residuals) out.add(residual);
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
    const std::size_t nodes_a_chunk =
        (count + 1) / Executor::chunks(features_.points.size(), kPointChunk) + 1;
    Eigen::MatrixXd J(6 * (count + 1), kPathSize);  // derivative of the pose at each node
    executor_.forChunks(
        count + 1, nodes_a_chunk,
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
        const PoseBlock end = in.hessian(2), both = in.hessian(1) - end;
        const PoseBlock start = in.hessian(0) - in.hessian(1) - both;
        HJ.middleRows<6>(row) += start * J.middleRows<6>(row) + both * J.middleRows<6>(row + 6);
        HJ.middleRows<6>(row + 6) += both * J.middleRows<6>(row) + end * J.middleRows<6>(row + 6);
        g.segment<6>(row) += in.gradient(0) - in.gradient(1);
        g.segment<6>(row + 6) += in.gradient(1);
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
        path, balance,
        [&](double r2, const Noise& noise, int) { sum += 0.5 * noise.judge(r2).rho; });
    return sum;
}

LidarFit LidarFactor::fit(const SweepPath& path, double balance) const
{
    LidarFit f;
    forResiduals(
        path, balance,
        [&](double r2, const Noise& noise, int rows)
        {
            const double w = noise.judge(r2).weight;
            f.count++;
            f.chi2 += w * r2 / noise.variance;
            f.weights += w * rows;
        });
    return f;
}

double LidarFactor::inlierWeight(const SweepPath& path) const
{
    double sum = 0;
    forResiduals(
        path, 1,
        [&](double r2, const Noise& noise, int) {
            sum += RobustKernel{Kernel::GemanMcClure, 3}.weight(r2 / noise.variance);
        });
    return sum;
}
}  // namespace taut
