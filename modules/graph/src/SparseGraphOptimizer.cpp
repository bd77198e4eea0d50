#include "taut/graph/SparseGraphOptimizer.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "NormalEquations.h"
#include "RobustWeights.h"
#include "optimizeBy.h"
#include "taut/graph/GraphResiduals.h"

IMPLEMENTS_MRPT_OBJECT(SparseGraphOptimizer, taut::GraphOptimizer, taut)

namespace taut
{
namespace
{
using Factorization = Eigen::SimplicialLDLT<NormalEquations::Hessian, Eigen::Lower>;

// Share of the diagonal's scale. The least one keeps directions that nothing sees from taking
// rounding errors for steps, and is too small to slow down any other.
constexpr double kLeastDamping = 1e-13, kFirstDamping = 1e-6, kMostDamping = 1e8;
constexpr int kRoughIterations = 8;
constexpr double kRoughStep = 0.1;  // sigmas

bool positiveDefinite(const Factorization& f)
{
    return f.info() == Eigen::Success && f.vectorD().allFinite() &&
           (f.vectorD().size() == 0 || f.vectorD().minCoeff() > 0);
}

/** Levenberg-Marquardt on one graph. */
class SparseProblem : public RobustProblem
{
 public:
    SparseProblem(const IndexedGraph& graph, const SparseGraphConfig& config)
        : graph_(graph), config_(config), first_(graph.poses()), poses_(first_)
    {
    }

    bool minimize(const std::vector<double>& weights, Effort effort) override
    {
        prepare(weights);
        const bool full = effort == Effort::Full;
        const int max_iterations =
            full ? config_.max_iterations : std::min(kRoughIterations, config_.max_iterations);
        const double min_step = full ? config_.min_step : kRoughStep;
        double cost = equations_->linearize(poses_, weights);
        double damping = kLeastDamping;
        if (equations_->size() == 0) return true;
        for (int i = 0; i < max_iterations && damping < kMostDamping; i++)
        {
            if (!factorize(damping))
            {
                damping = std::max(kFirstDamping, damping * 10);
                continue;
            }
            const Eigen::VectorXd step = factorization_.solve(-equations_->gradient());
            iterations_++;
            const double size =
                std::sqrt(std::max(0.0, -step.dot(equations_->gradient())));  // whitened
            // A step that is small since it is damped says nothing.
            const bool last = size < min_step && damping <= kFirstDamping;
            std::vector<Pose> next = equations_->moved(poses_, step);
            const double next_cost = costOf(graph_, next, weights);
            if (next_cost <= cost * (1 + 1e-12) + 1e-20)
            {
                poses_ = std::move(next);
                if (last || effort == Effort::Step) return true;
                cost = equations_->linearize(poses_, weights);
                damping = std::max(kLeastDamping, damping / 10);
                continue;
            }
            if (last) return true;
            damping = std::max(kFirstDamping, damping * 10);
        }
        return false;
    }

    double chi2(std::size_t e) const override
    {
        const auto& edge = graph_.relative_edges[e];
        const Vector6d r =
            relativeResidual(edge.edge->T_from_to, poses_[edge.from], poses_[edge.to]);
        return r.dot(edge.edge->information * r);
    }

    void save() override { saved_ = poses_; }
    void restore() override { poses_ = saved_; }

    /** Undoes what the way to the optimum has done to the gauge. */
    void finish(const std::vector<double>& weights)
    {
        restoreGauge(findGauge(graph_, poses_, weights), first_, poses_);
    }

    double cost(const std::vector<double>& weights) const override
    {
        return costOf(graph_, poses_, weights);
    }

    const std::vector<Pose>& poses() const { return poses_; }

    double gravityChi2(std::size_t k) const
    {
        const auto& e = graph_.gravity_edges[k];
        const Vector3d r = gravityResidual(e.edge->up_submap, poses_[e.vertex].R);
        return r.dot(e.edge->information * r);
    }
    int iterations() const { return iterations_; }

 private:
    /** Finds what is held: a closure that has lost its weight may leave a part alone. */
    void prepare(const std::vector<double>& weights)
    {
        Gauge gauge = findGauge(graph_, poses_, weights);
        if (equations_ && equations_->fits(gauge.hold, weights)) return;
        equations_ = std::make_unique<NormalEquations>(graph_, std::move(gauge.hold), weights);
        factorization_.analyzePattern(equations_->hessian());
    }

    bool factorize(double damping)
    {
        damped_ = equations_->hessian();
        const Eigen::VectorXd scale = equations_->diagonalScale();
        for (int c = 0; c < damped_.cols(); c++)
            damped_.valuePtr()[damped_.outerIndexPtr()[c]] += damping * scale[c];
        factorization_.factorize(damped_);
        return positiveDefinite(factorization_);
    }

    const IndexedGraph& graph_;
    const SparseGraphConfig& config_;
    const std::vector<Pose> first_;
    std::vector<Pose> poses_, saved_;
    std::unique_ptr<NormalEquations> equations_;
    NormalEquations::Hessian damped_;
    Factorization factorization_;
    int iterations_ = 0;
};

/** Columns of the inverse, by the factors of the Hessian. */
class SparseCovariance : public GraphCovariance
{
 public:
    SparseCovariance(PoseGraph graph, const std::vector<double>& weights)
        : copy_(std::move(graph)),
          graph_(copy_),
          poses_(graph_.poses()),
          gauge_(findGauge(graph_, poses_, weights)),
          equations_(graph_, gauge_.hold, weights)
    {
        equations_.linearize(poses_, weights);
        if (equations_.size() == 0) return;
        factorization_.compute(equations_.hessian());
        const Eigen::VectorXd diagonal = equations_.hessian().diagonal();
        if (!positiveDefinite(factorization_) ||
            (factorization_.vectorD().array() <
             1e-14 * (factorization_.permutationP() * diagonal).array())
                .any())
            throw std::runtime_error("pose graph: the edges leave a direction open");
    }

    Matrix12d joint(VertexId first, VertexId second) const override
    {
        return jointOf(graph_.indexOf(first), graph_.indexOf(second));
    }

    Matrix6d marginal(VertexId id) const override
    {
        const int v = graph_.indexOf(id);
        return block(v, columnsOf(v), v);
    }

    Matrix6d relative(VertexId from, VertexId to) const override
    {
        const int a = graph_.indexOf(from), b = graph_.indexOf(to);
        if (gauge_.first[a] != gauge_.first[b])
            throw std::invalid_argument(
                "pose graph: nothing connects vertices " + std::to_string(from) + " and " +
                std::to_string(to));
        return relativeCovariance(jointOf(a, b), poses_[a], poses_[b]);
    }

 private:
    Matrix12d jointOf(int a, int b) const
    {
        const Eigen::MatrixXd by_a = columnsOf(a), by_b = columnsOf(b);
        const Matrix6d across = block(b, by_a, a);
        Matrix12d result;
        result << block(a, by_a, a), across.transpose(), across, block(b, by_b, b);
        return result;
    }

    /** Columns of the inverse that belong to a vertex (all rows x 0, 2 or 6). */
    Eigen::MatrixXd columnsOf(int v) const
    {
        Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(equations_.size(), equations_.sizeOf(v));
        if (unit.cols() == 0) return unit;
        unit.middleRows(equations_.rowOf(v), equations_.sizeOf(v)).setIdentity();
        return factorization_.solve(unit);
    }

    /** Covariance of `row` with the vertex of these columns, in the whole tangent of both. */
    Matrix6d block(int row, const Eigen::MatrixXd& columns, int column) const
    {
        return freeDirections(gauge_.hold[row], poses_[row].R) *
               columns.middleRows(equations_.rowOf(row), equations_.sizeOf(row)) *
               freeDirections(gauge_.hold[column], poses_[column].R).transpose();
    }

    const PoseGraph copy_;
    const IndexedGraph graph_;
    const std::vector<Pose> poses_;
    const Gauge gauge_;
    NormalEquations equations_;
    Factorization factorization_;
};
}  // namespace

void SparseGraphOptimizer::configure(ConfigSection& section)
{
    section.key("max_iterations", config.max_iterations, {1, 1e6}, "of one solution");
    section.key("min_step", config.min_step, kPositive, "sigmas, whitened step that is converged");
    config.closures.declare(section);
}

GraphReport SparseGraphOptimizer::optimize(PoseGraph& graph) const
{
    return optimizeBy<SparseProblem>(config, graph);
}

std::shared_ptr<const GraphCovariance> SparseGraphOptimizer::covariance(
    const PoseGraph& graph, const std::vector<double>& weights) const
{
    return std::make_shared<SparseCovariance>(graph, weightsInOrder(IndexedGraph(graph), weights));
}
}  // namespace taut
