#include "taut/factors/LidarFactor.h"

#include <Eigen/Geometry>

namespace taut
{
namespace
{
constexpr std::size_t kChunk = 256;           // features
constexpr Duration kNodeSpacing = 2'500'000;  // [ns] between exact derivatives of the path
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

double variance(const Correspondence& c, const LidarNoiseConfig& noise, double balance)
{
    return balance * balance * (noise.sigma * noise.sigma + c.sigma * c.sigma);
}
}  // namespace

/** Sums of one chunk: kept apart and added in order, so that the total does not depend on threads.
 */
struct LidarFactor::Partial
{
    Eigen::Matrix<double, kPathSize, kPathSize> H = decltype(H)::Zero();
    Eigen::Matrix<double, kPathSize, 1> g = decltype(g)::Zero();
    double cost = 0;
};

namespace
{
/** Normal equations in the poses at both nodes of an interval (12 entries), carried to the states
 * when the interval is left. */
struct Interval
{
    Time begin = 0;
    PathJacobian at_begin, at_end;
    Eigen::Matrix<double, 12, 12> H;
    Eigen::Matrix<double, 12, 1> g;

    void enter(const SweepPath& path, Time t, std::size_t& hint)
    {
        begin = t - ((t % kNodeSpacing) + kNodeSpacing) % kNodeSpacing;
        path.poseAt(begin, hint, at_begin);
        path.poseAt(begin + kNodeSpacing, hint, at_end);
        H.setZero();
        g.setZero();
    }

    void leave(
        Eigen::Matrix<double, kPathSize, kPathSize>& H_out,
        Eigen::Matrix<double, kPathSize, 1>& g_out) const
    {
        Eigen::Matrix<double, 12, kPathSize> J;
        J << at_begin, at_end;
        const Eigen::Matrix<double, 12, kPathSize> HJ = H.selfadjointView<Eigen::Lower>() * J;
        H_out.noalias() += J.transpose() * HJ;
        g_out.noalias() += J.transpose() * g;
    }
};
}  // namespace

LidarFactor::LidarFactor(
    const Features& features, const LidarNoiseConfig& noise, Executor& executor)
    : features_(features), noise_(noise), executor_(executor)
{
}

void LidarFactor::setCorrespondences(const std::vector<Correspondence>& correspondences)
{
    correspondences_ = correspondences;
}

std::vector<Vector3d> LidarFactor::undistort(const SweepPath& path) const
{
    std::vector<Vector3d> world(features_.points.size());
    executor_.forChunks(
        world.size(), kChunk,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
            std::size_t hint = 0;
            for (std::size_t i = begin; i < end; i++)
                world[i] = path.poseAt(timeOf(i), hint) *
                           Vector3d(features_.points[i].position.cast<double>());
        });
    return world;
}

void LidarFactor::linearizeChunk(
    const SweepPath& path, double balance, std::size_t begin, std::size_t end, Partial& out) const
{
    Interval interval;
    bool inside = false;
    std::size_t hint = 0, node_hint = 0;
    for (std::size_t i = begin; i < end; i++)
    {
        const Correspondence& c = correspondences_[i];
        if (c.surface == Surface::None) continue;
        const Time t = timeOf(i);
        if (!inside || t >= interval.begin + kNodeSpacing)
        {
            if (inside) interval.leave(out.H, out.g);
            interval.enter(path, t, node_hint);
            inside = true;
        }
        const Pose pose = path.poseAt(t, hint);
        const Vector3d x = features_.points[i].position.cast<double>();
        const auto P = projection(c);
        const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1> r = P * (pose * x - c.point);

        const double s2 = variance(c, noise_, balance);
        const double e2 = r.squaredNorm() / s2;
        const double w = noise_.kernel.weight(e2) / s2;
        out.cost += 0.5 * noise_.kernel.rho(e2);

        // dy = dp - R [x]^ dtheta, shared between the nodes by the share of time.
        const double share =
            static_cast<double>(t - interval.begin) / static_cast<double>(kNodeSpacing);
        const Matrix3d by_theta = -pose.R * hat(x);
        for (int k = 0; k < r.size(); k++)
        {
            Eigen::Matrix<double, 6, 1> J6;
            J6 << P.row(k).transpose(), by_theta.transpose() * P.row(k).transpose();
            Eigen::Matrix<double, 12, 1> J;
            J << (1 - share) * J6, share * J6;
            interval.H.selfadjointView<Eigen::Lower>().rankUpdate(J, w);
            interval.g += J * (w * r[k]);
        }
    }
    if (inside) interval.leave(out.H, out.g);
}

double LidarFactor::linearize(
    const SweepPath& path, double balance, ProblemMatrix& hessian, ProblemVector& gradient) const
{
    std::vector<Partial> partial(Executor::chunks(features_.points.size(), kChunk));
    executor_.forChunks(
        features_.points.size(), kChunk,
        [&](std::size_t chunk, std::size_t begin, std::size_t end)
        { linearizeChunk(path, balance, begin, end, partial[chunk]); });
    double cost = 0;
    for (const Partial& p : partial)
    {
        hessian += p.H;
        gradient += p.g;
        cost += p.cost;
    }
    return cost;
}

template <class Body>
void LidarFactor::forResiduals(const SweepPath& path, double balance, const Body& body) const
{
    std::size_t hint = 0;
    for (std::size_t i = 0; i < correspondences_.size(); i++)
    {
        const Correspondence& c = correspondences_[i];
        if (c.surface == Surface::None) continue;
        const Vector3d y =
            path.poseAt(timeOf(i), hint) * Vector3d(features_.points[i].position.cast<double>());
        const Vector3d d = y - c.point;
        const double along = c.direction.dot(d);
        const double r2 =
            c.surface == Surface::Plane ? along * along : d.squaredNorm() - along * along;
        body(r2 / variance(c, noise_, balance), c.surface == Surface::Plane ? 1 : 2);
    }
}

double LidarFactor::cost(const SweepPath& path, double balance) const
{
    double sum = 0;
    forResiduals(path, balance, [&](double e2, int) { sum += 0.5 * noise_.kernel.rho(e2); });
    return sum;
}

LidarFit LidarFactor::fit(const SweepPath& path, double balance) const
{
    LidarFit f;
    forResiduals(
        path, balance,
        [&](double e2, int rows)
        {
            const double w = noise_.kernel.weight(e2);
            f.count++;
            f.chi2 += w * e2;
            f.weights += w * rows;
        });
    return f;
}
}  // namespace taut
