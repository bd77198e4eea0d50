#include "taut/core/PoseGraph.h"

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

std::ptrdiff_t PoseGraph::indexOf(VertexId id) const
{
    const auto found = std::find_if(
        vertices.begin(), vertices.end(), [id](const GraphVertex& v) { return v.id == id; });
    return found == vertices.end() ? -1 : found - vertices.begin();
}
}  // namespace taut
