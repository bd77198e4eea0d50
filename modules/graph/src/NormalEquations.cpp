#include "NormalEquations.h"

#include <algorithm>
#include <utility>

#include "taut/graph/GraphResiduals.h"

namespace taut
{
namespace
{
double chi2(const IndexedGraph::Relative& e, const std::vector<Pose>& poses)
{
    const Vector6d r = relativeResidual(e.edge->T_from_to, poses[e.from], poses[e.to]);
    return r.dot(e.edge->information * r);
}

double chi2(const IndexedGraph::Gravity& e, const std::vector<Pose>& poses)
{
    const Vector3d r = gravityResidual(e.edge->up_submap, poses[e.vertex].R);
    return r.dot(e.edge->information * r);
}
}  // namespace

double costOf(
    const IndexedGraph& graph, const std::vector<Pose>& poses, const std::vector<double>& weights)
{
    double cost = 0;
    for (std::size_t k = 0; k < graph.relative_edges.size(); k++)
        if (weights[k] != 0) cost += 0.5 * weights[k] * chi2(graph.relative_edges[k], poses);
    for (const auto& e : graph.gravity_edges) cost += 0.5 * chi2(e, poses);
    return cost;
}

NormalEquations::NormalEquations(
    const IndexedGraph& graph, std::vector<Hold> hold, const std::vector<double>& weights)
    : graph_(graph), hold_(std::move(hold))
{
    for (double weight : weights) pulls_.push_back(weight > 0);

    row_.push_back(0);
    for (Hold h : hold_)
        row_.push_back(row_.back() + (h == Hold::All ? 0 : h == Hold::Nothing ? 6 : 2));
    buildPattern();
    gradient_.resize(size());
}

void NormalEquations::buildPattern()
{
    const int n = static_cast<int>(hold_.size());
    std::vector<std::pair<int, int>> pairs;  // (column vertex, row vertex), column before row
    for (std::size_t k = 0; k < pulls_.size(); k++)
    {
        const auto& e = graph_.relative_edges[k];
        if (pulls_[k] && sizeOf(e.from) > 0 && sizeOf(e.to) > 0)
            pairs.emplace_back(std::min(e.from, e.to), std::max(e.from, e.to));
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());

    first_.assign(n + 1, 0);
    for (const auto& [column, row] : pairs) first_[column + 1]++;
    for (int v = 0; v < n; v++) first_[v + 1] += first_[v];
    below_.resize(pairs.size());
    block_row_.resize(pairs.size());
    hessian_.resize(size(), size());
    std::vector<int> outer(static_cast<std::size_t>(size()) + 1, 0);
    std::vector<int> inner;
    for (int v = 0; v < n; v++)
    {
        int below = 0;
        for (int b = first_[v]; b < first_[v + 1]; b++)
        {
            block_row_[b] = pairs[b].second;
            below_[b] = below;
            below += sizeOf(block_row_[b]);
        }
        for (int column = 0; column < sizeOf(v); column++)
        {
            for (int r = column; r < sizeOf(v); r++) inner.push_back(row_[v] + r);
            for (int b = first_[v]; b < first_[v + 1]; b++)
                for (int r = 0; r < sizeOf(block_row_[b]); r++)
                    inner.push_back(row_[block_row_[b]] + r);
            outer[row_[v] + column + 1] = static_cast<int>(inner.size());
        }
    }
    const std::vector<double> zeros(inner.size(), 0.0);
    hessian_ = Eigen::Map<const Hessian>(
        size(), size(), static_cast<int>(inner.size()), outer.data(), inner.data(), zeros.data());

    for (std::size_t k = 0; k < pulls_.size(); k++)
    {
        const auto& e = graph_.relative_edges[k];
        const bool has_block = pulls_[k] && sizeOf(e.from) > 0 && sizeOf(e.to) > 0;
        block_of_edge_.push_back(
            has_block ? blockOf(std::max(e.from, e.to), std::min(e.from, e.to)) : -1);
    }
}

bool NormalEquations::fits(const std::vector<Hold>& hold, const std::vector<double>& weights) const
{
    if (hold != hold_) return false;
    std::size_t idle = 0;
    for (std::size_t k = 0; k < weights.size(); k++)
    {
        if (weights[k] > 0 && !pulls_[k]) return false;
        idle += weights[k] <= 0 && pulls_[k];
    }
    return 100 * idle <= weights.size();
}

int NormalEquations::blockOf(int row_vertex, int column_vertex) const
{
    const auto begin = block_row_.begin() + first_[column_vertex];
    const auto end = block_row_.begin() + first_[column_vertex + 1];
    return static_cast<int>(std::lower_bound(begin, end, row_vertex) - block_row_.begin());
}

void NormalEquations::addBlock(int block, int row_vertex, int column_vertex, const Matrix6d& value)
{
    const int rows = sizeOf(row_vertex), columns = sizeOf(column_vertex);
    double* values = hessian_.valuePtr();
    const auto start = [&](int column)
    {
        return values + hessian_.outerIndexPtr()[row_[column_vertex] + column] +
               (columns - column) + below_[block];
    };
    if (rows == 6 && columns == 6)
    {
        for (int c = 0; c < 6; c++) Eigen::Map<Vector6d>(start(c)) += value.col(c);
        return;
    }
    const Eigen::MatrixXd reduced = basis_[row_vertex].transpose() * value * basis_[column_vertex];
    for (int c = 0; c < columns; c++) Eigen::Map<Eigen::VectorXd>(start(c), rows) += reduced.col(c);
}

void NormalEquations::addDiagonal(int vertex, const Matrix6d& value)
{
    const int n = sizeOf(vertex);
    if (n == 0) return;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> reduced = value;
    if (n < 6) reduced = basis_[vertex].transpose() * value * basis_[vertex];
    for (int c = 0; c < n; c++)
    {
        double* start = hessian_.valuePtr() + hessian_.outerIndexPtr()[row_[vertex] + c];
        for (int r = c; r < n; r++) start[r - c] += reduced(r, c);
    }
}

void NormalEquations::addGradient(int vertex, const Vector6d& value)
{
    const int n = sizeOf(vertex);
    if (n == 6)
        gradient_.segment<6>(row_[vertex]) += value;
    else if (n > 0)
        gradient_.segment(row_[vertex], n) += basis_[vertex].transpose() * value;
}

double NormalEquations::linearize(
    const std::vector<Pose>& poses, const std::vector<double>& weights)
{
    hessian_.coeffs().setZero();
    gradient_.setZero();
    basis_.clear();
    for (std::size_t v = 0; v < poses.size(); v++)
        basis_.push_back(freeDirections(hold_[v], poses[v].R));

    double cost = 0;
    for (std::size_t k = 0; k < graph_.relative_edges.size(); k++)
    {
        if (weights[k] == 0) continue;
        const auto& e = graph_.relative_edges[k];
        const auto l = linearizeRelative(e.edge->T_from_to, poses[e.from], poses[e.to]);
        const Matrix6d information = weights[k] * e.edge->information;
        const Vector6d pull = information * l.residual;
        const Matrix6d from = information * l.by_from, to = information * l.by_to;
        cost += 0.5 * l.residual.dot(pull);
        addGradient(e.from, l.by_from.transpose() * pull);
        addGradient(e.to, l.by_to.transpose() * pull);
        addDiagonal(e.from, l.by_from.transpose() * from);
        addDiagonal(e.to, l.by_to.transpose() * to);
        if (block_of_edge_[k] < 0) continue;
        if (e.to > e.from)
            addBlock(block_of_edge_[k], e.to, e.from, l.by_to.transpose() * from);
        else
            addBlock(block_of_edge_[k], e.from, e.to, l.by_from.transpose() * to);
    }
    for (const auto& e : graph_.gravity_edges)
    {
        const auto l = linearizeGravity(e.edge->up_submap, poses[e.vertex].R);
        const Vector3d pull = e.edge->information * l.residual;
        cost += 0.5 * l.residual.dot(pull);
        Vector6d gradient = Vector6d::Zero();
        gradient.tail<3>() = l.by_rotation.transpose() * pull;
        Matrix6d hessian = Matrix6d::Zero();
        hessian.bottomRightCorner<3, 3>() =
            l.by_rotation.transpose() * e.edge->information * l.by_rotation;
        addGradient(e.vertex, gradient);
        addDiagonal(e.vertex, hessian);
    }
    return cost;
}

Eigen::VectorXd NormalEquations::diagonalScale() const
{
    Eigen::VectorXd scale(size());
    for (int c = 0; c < size(); c++)
        scale[c] = hessian_.valuePtr()[hessian_.outerIndexPtr()[c]];  // the first of a column
    for (std::size_t v = 0; v < hold_.size(); v++)
    {
        const int n = sizeOf(static_cast<int>(v)), of_a_unit = n == 6 ? 3 : n;
        for (int start = row_[v]; start < row_[v] + n; start += of_a_unit)
        {
            auto unit = scale.segment(start, of_a_unit);
            const double largest = unit.maxCoeff();
            unit.setConstant(largest > 0 ? largest : 1);
        }
    }
    return scale;
}

std::vector<Pose> NormalEquations::moved(
    const std::vector<Pose>& poses, const Eigen::VectorXd& step) const
{
    std::vector<Pose> result = poses;
    for (std::size_t v = 0; v < poses.size(); v++)
    {
        const int n = sizeOf(static_cast<int>(v));
        if (n == 6)
            result[v] = perturbed(poses[v], step.segment<6>(row_[v]));
        else if (n > 0)
            result[v] = perturbed(
                poses[v], freeDirections(hold_[v], poses[v].R) * step.segment(row_[v], n));
    }
    return result;
}
}  // namespace taut
