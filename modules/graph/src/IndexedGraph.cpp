#include "IndexedGraph.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>

#include "taut/graph/GraphResiduals.h"

namespace taut
{
namespace
{
constexpr double kRotationTolerance = 1e-6;
constexpr double kInformationTolerance = 1e-9;  // of the matrix scaled to a diagonal of ones

[[noreturn]] void refuse(const std::string& where, const std::string& cause)
{
    throw std::invalid_argument("pose graph, " + where + ": " + cause);
}

void checkPose(const Pose& T, const std::string& where)
{
    if (!T.p.allFinite() || !T.R.allFinite()) refuse(where, "its pose is not finite");
    const Matrix3d error = T.R.transpose() * T.R - Matrix3d::Identity();
    if (error.cwiseAbs().maxCoeff() > kRotationTolerance || T.R.determinant() < 0)
        refuse(where, "its rotation is not a rotation matrix");
}

/** Scaled to a diagonal of ones, so that metres and radians weigh alike. False where the diagonal
 * already tells that the matrix is not positive semi-definite. */
bool scaleToOnes(Eigen::MatrixXd& m)
{
    for (int i = 0; i < m.rows(); i++)
    {
        const double d = m(i, i);
        if (d < 0 || (d == 0 && !m.row(i).isZero(0))) return false;
    }
    const Eigen::VectorXd scale =
        m.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0; });
    m = scale.asDiagonal() * m * scale.asDiagonal();
    return true;
}

template <int N>
void checkInformation(const Eigen::Matrix<double, N, N>& information, const std::string& where)
{
    if (!information.allFinite()) refuse(where, "its information is not finite");
    const double largest = information.cwiseAbs().maxCoeff();
    const Eigen::Matrix<double, N, N> skew = information - information.transpose();
    if (skew.cwiseAbs().maxCoeff() > kInformationTolerance * largest)
        refuse(where, "its information is not symmetric");
    if (Eigen::LLT<Eigen::Matrix<double, N, N>>(information).info() == Eigen::Success) return;
    Eigen::MatrixXd scaled = information;
    if (!scaleToOnes(scaled) ||
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
                .eigenvalues()[0] < -kInformationTolerance)
        refuse(where, "its information is not positive semi-definite");
}

std::string nameOf(const RelativeEdge& e)
{
    return "edge " + std::to_string(e.from) + " -> " + std::to_string(e.to);
}

std::string nameOf(const GravityEdge& e)
{
    return "gravity of vertex " + std::to_string(e.vertex);
}

/** Everything that an edge's pull depends on, in order. */
std::array<double, 48> contentOf(const RelativeEdge& e)
{
    std::array<double, 48> content;
    Eigen::Map<Matrix3d>(content.data()) = e.T_from_to.R;
    Eigen::Map<Vector3d>(content.data() + 9) = e.T_from_to.p;
    Eigen::Map<Matrix6d>(content.data() + 12) = e.information;
    return content;
}

std::array<double, 12> contentOf(const GravityEdge& e)
{
    std::array<double, 12> content;
    Eigen::Map<Vector3d>(content.data()) = e.up_submap;
    Eigen::Map<Matrix3d>(content.data() + 3) = e.information;
    return content;
}

bool before(const IndexedGraph::Relative& a, const IndexedGraph::Relative& b)
{
    const auto rank = [](const IndexedGraph::Relative& e)
    { return std::make_tuple(e.from, e.to, e.edge->kind, e.edge->enabled); };
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    return contentOf(*a.edge) < contentOf(*b.edge);
}

bool gravityBefore(const IndexedGraph::Gravity& a, const IndexedGraph::Gravity& b)
{
    if (a.vertex != b.vertex) return a.vertex < b.vertex;
    return contentOf(*a.edge) < contentOf(*b.edge);
}

/** Union-find in which a root is the lowest of its part. */
int rootOf(std::vector<int>& parent, int v)
{
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
}

std::vector<int> partsOf(const IndexedGraph& graph, const std::vector<double>& weights)
{
    std::vector<int> parent(graph.vertices.size());
    std::iota(parent.begin(), parent.end(), 0);
    for (std::size_t e = 0; e < graph.relative_edges.size(); e++)
    {
        const auto& edge = graph.relative_edges[e];
        if (weights[e] <= 0 || edge.edge->information.isZero(0)) continue;
        const int a = rootOf(parent, edge.from), b = rootOf(parent, edge.to);
        parent[std::max(a, b)] = std::min(a, b);
    }
    for (std::size_t v = 0; v < parent.size(); v++) parent[v] = rootOf(parent, static_cast<int>(v));
    return parent;
}

/** Whether gravity edges of that summed information, told in the world, know roll and pitch. */
bool knowsTilt(const Eigen::Matrix2d& horizontal)
{
    const auto eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(horizontal, Eigen::EigenvaluesOnly)
            .eigenvalues();
    return eigenvalues[1] > 0 && eigenvalues[0] > 1e-9 * eigenvalues[1];
}

/** The twist about z of a rotation: R = (swing) Exp(angle z), the swing about a horizontal axis. */
Matrix3d twistAboutZ(const Matrix3d& R)
{
    const Eigen::Quaterniond q(R);
    if (q.w() == 0 && q.z() == 0) return Matrix3d::Identity();
    return Eigen::Quaterniond(q.w(), 0, 0, q.z()).normalized().toRotationMatrix();
}
}  // namespace

void checkEdge(const RelativeEdge& e)
{
    if (e.from == e.to) refuse(nameOf(e), "both ends are the same vertex");
    checkPose(e.T_from_to, nameOf(e));
    checkInformation<6>(e.information, nameOf(e));
}

void checkEdge(const GravityEdge& e)
{
    if (!(std::abs(e.up_submap.norm() - 1) < kRotationTolerance))
        refuse(nameOf(e), "up_submap is not a unit vector");
    checkInformation<3>(e.information, nameOf(e));
}

IndexedGraph::IndexedGraph(const PoseGraph& graph)
{
    positions.resize(graph.vertices.size());
    std::iota(positions.begin(), positions.end(), std::size_t{0});
    const auto id = [&](std::size_t i) { return graph.vertices[i].id; };
    std::stable_sort(
        positions.begin(), positions.end(),
        [&](std::size_t a, std::size_t b) { return id(a) < id(b); });
    for (std::size_t i : positions)
    {
        const GraphVertex& v = graph.vertices[i];
        const std::string name = "vertex " + std::to_string(v.id);
        if (!vertices.empty() && vertices.back()->id == v.id) refuse(name, "is given twice");
        checkPose(v.T_world_submap, name);
        vertices.push_back(&v);
    }
    for (std::size_t i = 0; i < graph.relative_edges.size(); i++)
    {
        const RelativeEdge& e = graph.relative_edges[i];
        checkEdge(e);
        relative_edges.push_back({indexOf(e.from), indexOf(e.to), i, &e});
    }
    for (std::size_t i = 0; i < graph.gravity_edges.size(); i++)
    {
        const GravityEdge& e = graph.gravity_edges[i];
        checkEdge(e);
        gravity_edges.push_back({indexOf(e.vertex), i, &e});
    }
    std::stable_sort(relative_edges.begin(), relative_edges.end(), before);
    std::stable_sort(gravity_edges.begin(), gravity_edges.end(), gravityBefore);
}

int IndexedGraph::indexOf(VertexId id) const
{
    const auto found = std::lower_bound(
        vertices.begin(), vertices.end(), id,
        [](const GraphVertex* v, VertexId wanted) { return v->id < wanted; });
    if (found == vertices.end() || (*found)->id != id)
        refuse("vertex " + std::to_string(id), "is unknown");
    return static_cast<int>(found - vertices.begin());
}

std::vector<Pose> IndexedGraph::poses() const
{
    std::vector<Pose> result;
    result.reserve(vertices.size());
    for (const GraphVertex* v : vertices) result.push_back(v->T_world_submap);
    return result;
}

std::vector<double> startingWeights(const IndexedGraph& graph)
{
    std::vector<double> weights;
    weights.reserve(graph.relative_edges.size());
    for (const auto& e : graph.relative_edges) weights.push_back(e.edge->enabled ? 1 : 0);
    return weights;
}

std::vector<std::size_t> closuresOf(const IndexedGraph& graph)
{
    std::vector<std::size_t> closures;
    for (std::size_t e = 0; e < graph.relative_edges.size(); e++)
    {
        const RelativeEdge& edge = *graph.relative_edges[e].edge;
        if (edge.enabled && edge.kind == EdgeKind::LoopClosure) closures.push_back(e);
    }
    return closures;
}

std::vector<double> weightsInOrder(const IndexedGraph& graph, const std::vector<double>& weights)
{
    std::vector<double> result = startingWeights(graph);
    if (weights.empty()) return result;
    if (weights.size() != result.size())
        refuse("weights", "their number is not that of the relative edges");
    for (std::size_t e = 0; e < result.size(); e++)
    {
        const double weight = weights[graph.relative_edges[e].position];
        if (!(weight >= 0 && weight <= 1)) refuse("weights", "one is not from 0 to 1");
        result[e] *= weight;
    }
    return result;
}

Gauge findGauge(
    const IndexedGraph& graph, const std::vector<Pose>& poses, const std::vector<double>& weights)
{
    const std::size_t n = graph.vertices.size();
    Gauge gauge{
        partsOf(graph, weights), std::vector<Hold>(n, Hold::Nothing), std::vector<bool>(n, true),
        std::vector<bool>(n, false)};
    std::vector<Eigen::Matrix2d> tilt(n, Eigen::Matrix2d::Zero());
    for (std::size_t v = 0; v < n; v++)
    {
        if (!graph.vertices[v]->fixed) continue;
        gauge.hold[v] = Hold::All;
        gauge.free[gauge.first[v]] = false;
    }
    for (const auto& e : graph.gravity_edges)
    {
        const Matrix3d& R = poses[e.vertex].R;
        const int part = gauge.first[e.vertex];
        tilt[part] += (R * e.edge->information * R.transpose()).topLeftCorner<2, 2>();
        gauge.tilts[part] = true;
    }
    for (std::size_t v = 0; v < n; v++)
    {
        const int part = gauge.first[v];
        if (part == static_cast<int>(v) && gauge.free[v])
            gauge.hold[v] = knowsTilt(tilt[v]) ? Hold::PositionAndYaw : Hold::All;
        gauge.free[v] = gauge.free[part];
        gauge.tilts[v] = gauge.tilts[part];
    }
    return gauge;
}

void restoreGauge(const Gauge& gauge, const std::vector<Pose>& before, std::vector<Pose>& poses)
{
    const std::vector<Pose> now = poses;
    for (std::size_t v = 0; v < poses.size(); v++)
    {
        if (!gauge.free[v]) continue;
        const Pose& was = before[gauge.first[v]];
        const Pose& is = now[gauge.first[v]];
        const Matrix3d turn = is.R * was.R.transpose();
        const Matrix3d back = gauge.tilts[v] ? twistAboutZ(turn) : turn;
        poses[v].R = normalizedRotation(back.transpose() * now[v].R);
        poses[v].p = was.p + back.transpose() * (now[v].p - is.p);
    }
}

TangentBasis freeDirections(Hold hold, const Matrix3d& R_world_submap)
{
    if (hold == Hold::All) return TangentBasis(6, 0);
    if (hold == Hold::Nothing) return Matrix6d::Identity();
    TangentBasis basis = TangentBasis::Zero(6, 2);
    basis.bottomRows<3>() = R_world_submap.transpose().leftCols<2>();
    return basis;
}

Matrix6d relativeCovariance(
    const Eigen::Matrix<double, 12, 12>& joint, const Pose& T_world_from, const Pose& T_world_to)
{
    const auto linearized =
        linearizeRelative(T_world_from.inverse() * T_world_to, T_world_from, T_world_to);
    Eigen::Matrix<double, 6, 12> J;
    J << linearized.by_from, linearized.by_to;
    return J * joint * J.transpose();
}
}  // namespace taut
