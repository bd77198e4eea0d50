#include "taut/graph/DenseGraphOptimizer.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "IndexedGraph.h"
#include "RobustWeights.h"
#include "optimizeBy.h"

IMPLEMENTS_MRPT_OBJECT(DenseGraphOptimizer, taut::GraphOptimizer, taut)

namespace taut
{
namespace
{
constexpr double kDifference = 1e-5;  // m and rad, of the numeric derivatives
constexpr int kRoughIterations = 8;
constexpr double kRoughStep = 0.1;  // sigmas
constexpr int kHalvings = 10;

/** A pose as the textbooks of quaternions have it. */
struct State
{
    Eigen::Quaterniond q;
    Vector3d p;
};

Eigen::Quaterniond quaternionOf(const Vector3d& rotation_vector)
{
    const double angle = rotation_vector.norm();
    if (angle == 0) return Eigen::Quaterniond::Identity();
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

Vector3d rotationVectorOf(Eigen::Quaterniond q)
{
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    const double sine = q.vec().norm();
    return sine < 1e-12 ? Vector3d(2 * q.vec()) : q.vec() * (2 * std::atan2(sine, q.w()) / sine);
}

/** Both parts are moved in the frame of the submap; of a vertex that keeps its position and yaw,
 * the rotation is moved about the two horizontal axes of the world. */
State moved(const State& s, Hold hold, const Eigen::VectorXd& delta)
{
    if (hold == Hold::All) return s;
    if (hold == Hold::PositionAndYaw)
        return {(quaternionOf({delta[0], delta[1], 0}) * s.q).normalized(), s.p};
    const Vector3d translation = delta.head<3>(), rotation = delta.tail<3>();
    return {(s.q * quaternionOf(rotation)).normalized(), s.p + s.q * translation};
}

int sizeOf(Hold hold)
{
    return hold == Hold::All ? 0 : hold == Hold::PositionAndYaw ? 2 : 6;
}

Eigen::VectorXd errorOf(const RelativeEdge& e, const State& from, const State& to)
{
    const Eigen::Quaterniond measured(e.T_from_to.R);
    const Vector3d to_in_from = from.q.conjugate() * (to.p - from.p);
    Eigen::VectorXd error(6);
    error << measured.conjugate() * (to_in_from - e.T_from_to.p),
        rotationVectorOf(measured.conjugate() * from.q.conjugate() * to.q);
    return error;
}

Eigen::VectorXd errorOf(const GravityEdge& e, const State& s)
{
    // The shortest turn from the measured up to that of the state.
    const Vector3d up = s.q.conjugate() * Vector3d::UnitZ();
    return -rotationVectorOf(Eigen::Quaterniond::FromTwoVectors(e.up_submap, up));
}

class DenseProblem : public RobustProblem
{
 public:
    DenseProblem(const IndexedGraph& graph, const DenseGraphConfig& config)
        : graph_(graph), config_(config)
    {
        for (const GraphVertex* v : graph.vertices)
            states_.push_back(
                {Eigen::Quaterniond(v->T_world_submap.R).normalized(), v->T_world_submap.p});
    }

    bool minimize(const std::vector<double>& weights, Effort effort) override
    {
        const bool full = effort == Effort::Full;
        const double min_step = full ? config_.min_step : kRoughStep;
        const int max_iterations =
            full ? config_.max_iterations : std::min(kRoughIterations, config_.max_iterations);
        hold(findGauge(graph_, poses(), weights).hold);
        if (row_.back() == 0) return true;
        double ridge = 1e-13;  // share of the diagonal, for directions that nothing sees
        for (int i = 0; i < max_iterations && ridge < 1e8; i++)
        {
            Eigen::VectorXd g;
            Eigen::MatrixXd H = linearize(weights, g);
            addRidge(ridge, H);
            const Eigen::LLT<Eigen::MatrixXd> llt(H);
            if (llt.info() != Eigen::Success)
            {
                ridge *= 1000;
                continue;
            }
            const Eigen::VectorXd step = llt.solve(-g);
            iterations_++;
            const double size = std::sqrt(std::max(0.0, -step.dot(g)));
            const bool goes_down = goAlong(step, weights);
            if (size < min_step && ridge < 1e-5) return true;
            if (goes_down && effort == Effort::Step) return true;
            ridge = goes_down ? std::max(1e-13, ridge / 1000) : ridge * 1000;
        }
        return false;
    }

    double chi2(std::size_t k) const override
    {
        const auto& e = graph_.relative_edges[k];
        const Eigen::VectorXd r = errorOf(*e.edge, states_[e.from], states_[e.to]);
        return r.dot(e.edge->information * r);
    }

    double gravityChi2(std::size_t k) const
    {
        const auto& e = graph_.gravity_edges[k];
        const Eigen::VectorXd r = errorOf(*e.edge, states_[e.vertex]);
        return r.dot(e.edge->information * r);
    }

    void save() override { saved_ = states_; }
    void restore() override { states_ = saved_; }

    double cost(const std::vector<double>& weights) const override
    {
        double twice = 0;
        for (std::size_t k = 0; k < weights.size(); k++)
            if (weights[k] > 0) twice += weights[k] * chi2(k);
        for (std::size_t k = 0; k < graph_.gravity_edges.size(); k++) twice += gravityChi2(k);
        return twice / 2;
    }

    void finish(const std::vector<double>& weights)
    {
        std::vector<Pose> result = poses();
        const std::vector<Pose> before = graph_.poses();
        restoreGauge(findGauge(graph_, result, weights), before, result);
        for (std::size_t v = 0; v < states_.size(); v++)
            states_[v] = {Eigen::Quaterniond(result[v].R), result[v].p};
    }

    /** Poses as rotation matrices. */
    std::vector<Pose> poses() const
    {
        std::vector<Pose> result;
        result.reserve(states_.size());
        for (const State& s : states_) result.push_back({s.q.toRotationMatrix(), s.p});
        return result;
    }

    /** Says what is held, by vertex. */
    void hold(const std::vector<Hold>& hold)
    {
        hold_ = hold;
        row_.assign(1, 0);
        for (Hold h : hold_) row_.push_back(row_.back() + sizeOf(h));
    }

    /** Gauss-Newton Hessian (returned) and gradient. */
    Eigen::MatrixXd linearize(const std::vector<double>& weights, Eigen::VectorXd& g) const
    {
        Eigen::MatrixXd H = Eigen::MatrixXd::Zero(row_.back(), row_.back());
        g = Eigen::VectorXd::Zero(row_.back());
        for (std::size_t k = 0; k < weights.size(); k++)
        {
            if (weights[k] <= 0) continue;
            const auto& e = graph_.relative_edges[k];
            const State &from = states_[e.from], &to = states_[e.to];
            const Eigen::MatrixXd A =
                derivative(e.from, [&](const State& s) { return errorOf(*e.edge, s, to); });
            const Eigen::MatrixXd B =
                derivative(e.to, [&](const State& s) { return errorOf(*e.edge, from, s); });
            const Eigen::MatrixXd W = weights[k] * e.edge->information;
            const Eigen::VectorXd r = errorOf(*e.edge, from, to);
            add(H, e.from, e.from, A.transpose() * W * A);
            add(H, e.from, e.to, A.transpose() * W * B);
            add(H, e.to, e.from, B.transpose() * W * A);
            add(H, e.to, e.to, B.transpose() * W * B);
            g.segment(row_[e.from], A.cols()) += A.transpose() * W * r;
            g.segment(row_[e.to], B.cols()) += B.transpose() * W * r;
        }
        for (const auto& e : graph_.gravity_edges)
        {
            const Eigen::MatrixXd A =
                derivative(e.vertex, [&](const State& s) { return errorOf(*e.edge, s); });
            const Eigen::VectorXd r = errorOf(*e.edge, states_[e.vertex]);
            add(H, e.vertex, e.vertex, A.transpose() * e.edge->information * A);
            g.segment(row_[e.vertex], A.cols()) += A.transpose() * e.edge->information * r;
        }
        return H;
    }

    int rowOf(int v) const { return row_[v]; }
    int sizeOfVertex(int v) const { return row_[v + 1] - row_[v]; }
    int iterations() const { return iterations_; }

 private:
    template <class Error>
    Eigen::MatrixXd derivative(int v, const Error& error) const
    {
        const int n = sizeOfVertex(v);
        Eigen::MatrixXd J(error(states_[v]).size(), n);
        for (int i = 0; i < n; i++)
        {
            const Eigen::VectorXd d = kDifference * Eigen::VectorXd::Unit(n, i);
            J.col(i) =
                (error(moved(states_[v], hold_[v], d)) - error(moved(states_[v], hold_[v], -d))) /
                (2 * kDifference);
        }
        return J;
    }

    void add(Eigen::MatrixXd& H, int a, int b, const Eigen::MatrixXd& block) const
    {
        H.block(row_[a], row_[b], block.rows(), block.cols()) += block;
    }

    /** The same along each axis of a translation or a rotation, whatever the frames are. */
    void addRidge(double ridge, Eigen::MatrixXd& H) const
    {
        for (std::size_t v = 0; v < hold_.size(); v++)
        {
            const int n = sizeOf(hold_[v]), half = n == 6 ? 3 : n;
            for (int start = row_[v]; start < row_[v] + n; start += half)
            {
                const double trace = H.diagonal().segment(start, half).sum();
                H.diagonal().segment(start, half).array() += trace > 0 ? ridge * trace : 1.0;
            }
        }
    }

    /** Takes the step, or the first of its halves that does not raise the cost. */
    bool goAlong(Eigen::VectorXd step, const std::vector<double>& weights)
    {
        const std::vector<State> start = states_;
        const double before = cost(weights);
        for (int halving = 0; halving < kHalvings; halving++, step /= 2)
        {
            for (std::size_t v = 0; v < start.size(); v++)
                states_[v] = moved(start[v], hold_[v], step.segment(row_[v], sizeOf(hold_[v])));
            if (cost(weights) <= before * (1 + 1e-12) + 1e-20) return true;
        }
        states_ = start;
        return false;
    }

    const IndexedGraph& graph_;
    const DenseGraphConfig& config_;
    std::vector<State> states_, saved_;
    std::vector<Hold> hold_;
    std::vector<int> row_;
    int iterations_ = 0;
};

/** The inverse as a whole. */
class DenseCovariance : public GraphCovariance
{
 public:
    DenseCovariance(PoseGraph graph, const std::vector<double>& weights)
        : copy_(std::move(graph)),
          graph_(copy_),
          poses_(graph_.poses()),
          gauge_(findGauge(graph_, poses_, weights))
    {
        const DenseGraphConfig config;
        DenseProblem problem(graph_, config);
        problem.hold(gauge_.hold);
        Eigen::VectorXd g;
        const Eigen::MatrixXd H = problem.linearize(weights, g);
        const int n = static_cast<int>(poses_.size());
        const Eigen::LDLT<Eigen::MatrixXd> ldlt(H);
        if (H.rows() > 0 &&
            !(ldlt.vectorD().minCoeff() > 1e-14 * ldlt.vectorD().cwiseAbs().maxCoeff()))
            throw std::runtime_error("pose graph: the edges leave a direction open");

        // To the tangent that all optimisers share: from the submap's frame, or the world's axes.
        Eigen::MatrixXd D = Eigen::MatrixXd::Zero(6 * n, H.rows());
        for (int v = 0; v < n; v++)
        {
            const Matrix3d& R = poses_[v].R;
            if (gauge_.hold[v] == Hold::PositionAndYaw)
                D.block<3, 2>(6 * v + 3, problem.rowOf(v)) = R.transpose().leftCols<2>();
            if (gauge_.hold[v] != Hold::Nothing) continue;
            D.block<3, 3>(6 * v, problem.rowOf(v)) = R;
            D.block<3, 3>(6 * v + 3, problem.rowOf(v) + 3).setIdentity();
        }
        if (H.rows() > 0)
            covariance_ = D * ldlt.solve(D.transpose());
        else
            covariance_ = Eigen::MatrixXd::Zero(6 * n, 6 * n);
    }

    Matrix12d joint(VertexId first, VertexId second) const override
    {
        const int a = 6 * graph_.indexOf(first), b = 6 * graph_.indexOf(second);
        Matrix12d result;
        result << covariance_.block<6, 6>(a, a), covariance_.block<6, 6>(a, b),
            covariance_.block<6, 6>(b, a), covariance_.block<6, 6>(b, b);
        return result;
    }

    Matrix6d marginal(VertexId id) const override { return joint(id, id).topLeftCorner<6, 6>(); }

    Matrix6d relative(VertexId from, VertexId to) const override
    {
        const int a = graph_.indexOf(from), b = graph_.indexOf(to);
        if (gauge_.first[a] != gauge_.first[b])
            throw std::invalid_argument(
                "pose graph: nothing connects vertices " + std::to_string(from) + " and " +
                std::to_string(to));
        return relativeCovariance(joint(from, to), poses_[a], poses_[b]);
    }

 private:
    const PoseGraph copy_;
    const IndexedGraph graph_;
    const std::vector<Pose> poses_;
    const Gauge gauge_;
    Eigen::MatrixXd covariance_;
};
}  // namespace

void DenseGraphOptimizer::configure(ConfigSection& section)
{
    section.key("max_iterations", config.max_iterations, {1, 1e6}, "of one solution");
    section.key("min_step", config.min_step, kPositive, "sigmas, whitened step that is converged");
    config.closures.declare(section);
}

GraphReport DenseGraphOptimizer::optimize(PoseGraph& graph) const
{
    return optimizeBy<DenseProblem>(config, graph);
}

std::shared_ptr<const GraphCovariance> DenseGraphOptimizer::covariance(
    const PoseGraph& graph, const std::vector<double>& weights) const
{
    return std::make_shared<DenseCovariance>(graph, weightsInOrder(IndexedGraph(graph), weights));
}
}  // namespace taut
