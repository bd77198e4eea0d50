#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "IndexedGraph.h"

namespace taut
{
/** 1/2 sum w r^T Omega r. */
double costOf(
    const IndexedGraph& graph, const std::vector<Pose>& poses, const std::vector<double>& weights);

/** Hessian H = J^T W Omega J (lower triangle) and gradient g = J^T W Omega r of a graph, over the
 * directions that are free. The pattern of H is found once, and the values filled in for each
 * linearisation. */
class NormalEquations
{
 public:
    using Hessian = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

    /** Edges without weight have no place in the pattern: those of false closures cost most. */
    NormalEquations(
        const IndexedGraph& graph, std::vector<Hold> hold, const std::vector<double>& weights);

    /** Whether the pattern serves these too: it has room for every edge with weight, and few edges
     * in it have lost theirs. */
    bool fits(const std::vector<Hold>& hold, const std::vector<double>& weights) const;

    /** Fills both, at those poses; returns the cost 1/2 sum w r^T Omega r there. */
    double linearize(const std::vector<Pose>& poses, const std::vector<double>& weights);

    /** By row, the largest entry of the diagonal among those of the same vertex and unit; 1 where
     * that is none. Steps that are damped by it do not depend on the axes of the frames. */
    Eigen::VectorXd diagonalScale() const;

    /** The poses moved by a step in the free directions. */
    std::vector<Pose> moved(const std::vector<Pose>& poses, const Eigen::VectorXd& step) const;

    /** First row of a vertex, and how many it has (0, 2 or 6). */
    int rowOf(int vertex) const { return row_[vertex]; }
    int sizeOf(int vertex) const { return row_[vertex + 1] - row_[vertex]; }
    int size() const { return row_.back(); }

    const Hessian& hessian() const { return hessian_; }
    Hessian& hessian() { return hessian_; }
    const Eigen::VectorXd& gradient() const { return gradient_; }

 private:
    void buildPattern();
    int blockOf(int row_vertex, int column_vertex) const;
    void addBlock(int block, int row_vertex, int column_vertex, const Matrix6d& value);
    void addDiagonal(int vertex, const Matrix6d& value);
    void addGradient(int vertex, const Vector6d& value);

    const IndexedGraph& graph_;
    std::vector<Hold> hold_;
    std::vector<bool> pulls_;  // by edge: it is in the pattern
    std::vector<int> row_;     // of each vertex, and their number at the end
    // Blocks below the diagonal, by column vertex: those of vertex v are [first_[v], first_[v +
    // 1]).
    std::vector<int> first_, block_row_;
    std::vector<int> below_;          // of each block: rows between the diagonal block and it
    std::vector<int> block_of_edge_;  // -1: one of its ends is held
    std::vector<TangentBasis> basis_;
    Hessian hessian_;
    Eigen::VectorXd gradient_;
};
}  // namespace taut
