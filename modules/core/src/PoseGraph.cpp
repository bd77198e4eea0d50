#include "taut/core/PoseGraph.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace taut
{
Matrix6d rightFromLeft(const Pose& T)
{
    Matrix6d J = Matrix6d::Zero();
    J.topLeftCorner<3, 3>() = J.bottomRightCorner<3, 3>() = T.R.transpose();
    J.topRightCorner<3, 3>() = -T.R.transpose() * hat(T.p);
    return J;
}

Vector6d rightErrorTo(const Pose& T, const Pose& other)
{
    Vector6d d;
    d << T.R.transpose() * (other.p - T.p), logSO3(T.R.transpose() * other.R);
    return d;
}

ShownDirections shownDirections(const Matrix6d& information)
{
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information);
    const double least = 1e-9 * eigen.eigenvalues().maxCoeff();
    int open = 0;
    while (open < 6 && eigen.eigenvalues()[open] <= least) open++;
    return {eigen.eigenvectors().rightCols(6 - open), eigen.eigenvalues().tail(6 - open)};
}

std::ptrdiff_t PoseGraph::indexOf(VertexId id) const
{
    const auto found = std::find_if(
        vertices.begin(), vertices.end(), [id](const GraphVertex& v) { return v.id == id; });
    return found == vertices.end() ? -1 : found - vertices.begin();
}
}  // namespace taut
