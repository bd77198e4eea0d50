/** \file
 * What every optimiser of pose graphs must do: add a class name below to hold another one to it. */
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cstring>
#include <functional>
#include <limits>

#include "graphs.h"
#include "taut/core/GraphOptimizer.h"
#include "taut/core/Plugins.h"
#include "taut/graph/GraphResiduals.h"
#include "taut/graph/Register.h"

using namespace taut;
using namespace taut::test;

namespace
{
std::shared_ptr<GraphOptimizer> makeOptimizer(const std::string& name, const std::string& yaml = "")
{
    registerGraphOptimizers();
    ConfigSection section(yaml.empty() ? YamlNode() : parseYaml(yaml), "graph");
    auto optimizer = createPlugin<GraphOptimizer>(name);
    optimizer->configure(section);
    section.rejectUnknown();
    return optimizer;
}

class AnyGraphOptimizer : public ::testing::TestWithParam<const char*>
{
 protected:
    std::shared_ptr<GraphOptimizer> optimizer = makeOptimizer(GetParam());
};

/** Largest difference of positions [m] and rotations [rad]; vertices in the same order. */
double difference(const PoseGraph& a, const PoseGraph& b)
{
    double largest = 0;
    for (std::size_t i = 0; i < a.vertices.size(); i++)
    {
        const Pose &x = a.vertices[i].T_world_submap, &y = b.vertices[i].T_world_submap;
        largest = std::max({largest, (x.p - y.p).norm(), logSO3(x.R.transpose() * y.R).norm()});
    }
    return largest;
}

PoseGraph movedBy(const Pose& T, PoseGraph graph)
{
    for (GraphVertex& v : graph.vertices) v.T_world_submap = T * v.T_world_submap;
    return graph;
}

/** Whitened-free cost by the public residuals. */
double costOf(const PoseGraph& graph, const std::vector<double>& weights)
{
    const auto pose = [&](VertexId id) { return graph.vertices[graph.indexOf(id)].T_world_submap; };
    double cost = 0;
    for (std::size_t i = 0; i < graph.relative_edges.size(); i++)
    {
        const RelativeEdge& e = graph.relative_edges[i];
        const Vector6d r = relativeResidual(e.T_from_to, pose(e.from), pose(e.to));
        cost += 0.5 * weights[i] * r.dot(e.information * r);
    }
    for (const GravityEdge& e : graph.gravity_edges)
    {
        const Vector3d r = gravityResidual(e.up_submap, pose(e.vertex).R);
        cost += 0.5 * r.dot(e.information * r);
    }
    return cost;
}

/** Gauss-Newton Hessian over (p, theta) of all vertices, by numeric derivatives. */
Eigen::MatrixXd numericHessian(const PoseGraph& graph)
{
    const int n = 6 * static_cast<int>(graph.vertices.size());
    const auto pose = [&](VertexId id, const Eigen::VectorXd& d)
    {
        const auto i = graph.indexOf(id);
        return perturbed(graph.vertices[i].T_world_submap, d.segment<6>(6 * i));
    };
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
    for (const RelativeEdge& e : graph.relative_edges)
    {
        const auto J = numericJacobian(
            [&](const Eigen::VectorXd& d)
            { return relativeResidual(e.T_from_to, pose(e.from, d), pose(e.to, d)); },
            n);
        H += J.transpose() * e.information * J;
    }
    for (const GravityEdge& e : graph.gravity_edges)
    {
        const auto J = numericJacobian(
            [&](const Eigen::VectorXd& d)
            { return gravityResidual(e.up_submap, pose(e.vertex, d).R); },
            n);
        H += J.transpose() * e.information * J;
    }
    return H;
}

/** How many closures are true and yet have no weight. */
int trueClosuresRefused(const GraphWithTruth& graph, const GraphReport& report)
{
    int refused = 0;
    for (std::size_t i = 0; i < report.weights.size(); i++)
        refused += graph.graph.relative_edges[i].kind == EdgeKind::LoopClosure &&
                   report.weights[i] == 0 &&
                   std::count(graph.false_closures.begin(), graph.false_closures.end(), i) == 0;
    return refused;
}

/** A ring of edges along and about one axis, which commute: there and back, with a gap. */
PoseGraph screwRing(const std::vector<double>& variances, double gap_x, double gap_angle)
{
    PoseGraph graph;
    const int n = static_cast<int>(variances.size());
    Pose T;
    for (int i = 0; i < n; i++)
    {
        graph.vertices.push_back({i, T, i == 0});
        RelativeEdge e;
        e.from = i;
        e.to = (i + 1) % n;
        const double way = i < n / 2 ? 1 : -1;
        e.T_from_to = {expSO3({0.3 * way + gap_angle / n, 0, 0}), {2 * way + gap_x / n, 0, 0}};
        e.information = informationOf((Vector6d() << 0.1, 0.2, 0.3, 0.01, 0.02, 0.03).finished());
        e.information(0, 3) = e.information(3, 0) = 500;  // and both correlate
        e.information /= variances[i];
        graph.relative_edges.push_back(e);
        T = T * e.T_from_to;
    }
    return graph;
}

void expectSpread(
    const GraphOptimizer& optimizer, const std::vector<double>& variances, double gap_x,
    double gap_angle)
{
    PoseGraph graph = screwRing(variances, gap_x, gap_angle);
    const GraphReport report = optimizer.optimize(graph);
    EXPECT_TRUE(report.converged);
    double sum = 0;
    for (double v : variances) sum += v;
    for (std::size_t i = 0; i < variances.size(); i++)
    {
        const RelativeEdge& e = graph.relative_edges[i];
        const Vector6d r = relativeResidual(
            e.T_from_to, graph.vertices[e.from].T_world_submap,
            graph.vertices[e.to].T_world_submap);
        Vector6d expected = Vector6d::Zero();
        expected[0] = -gap_x * variances[i] / sum;
        expected[3] = -gap_angle * variances[i] / sum;
        EXPECT_LT((r - expected).cwiseAbs().maxCoeff(), 1e-9) << "edge " << i;
        EXPECT_NEAR(report.relative_chi2[i], expected.dot(e.information * expected), 1e-6);
    }
}
}  // namespace

TEST_P(AnyGraphOptimizer, SpreadsTheGapOfARingEvenlyOverEqualEdges)
{
    expectSpread(*optimizer, std::vector<double>(12, 1.0), 0.6, 0.12);
}

TEST_P(AnyGraphOptimizer, SpreadsTheGapOfARingByTheVarianceOfItsEdges)
{
    expectSpread(*optimizer, {1, 2, 3, 4, 1, 1, 0.1, 20}, -0.5, 0.2);
}

TEST_P(AnyGraphOptimizer, ReachesAMinimumOfTheCost)
{
    for (bool gravity : {false, true})
    {
        PoseGraph graph = anyGraph(30, 5, gravity).graph;
        const double first_cost =
            costOf(graph, std::vector<double>(graph.relative_edges.size(), 1.0));
        const GraphReport report = optimizer->optimize(graph);
        EXPECT_TRUE(report.converged);
        EXPECT_GT(report.iterations, 0);
        EXPECT_NEAR(report.initial_cost, first_cost, 1e-9 * first_cost);
        EXPECT_LT(report.final_cost, 0.5 * report.initial_cost);
        EXPECT_NEAR(report.final_cost, costOf(graph, report.weights), 1e-8 * report.final_cost);
        for (std::size_t i = 1; i < graph.vertices.size(); i++)
            for (int k = 0; k < 6; k++)
            {
                const auto cost = [&](double d)
                {
                    PoseGraph moved = graph;
                    Pose& T = moved.vertices[i].T_world_submap;
                    T = perturbed(T, d * Vector6d::Unit(k));
                    return costOf(moved, report.weights);
                };
                const double h = 1e-4;
                const double slope = (cost(h) - cost(-h)) / (2 * h);
                const double curvature = (cost(h) + cost(-h) - 2 * cost(0)) / (h * h);
                EXPECT_GT(curvature, 0);
                EXPECT_LT(std::abs(slope / curvature), 1e-6) << i << ' ' << k;  // m, rad to go
            }
    }
}

TEST_P(AnyGraphOptimizer, ADirectionThatAClosureDoesNotSeeStaysOpen)
{
    // A chain along x that drifts to the side, and a closure that knows nothing along x.
    const auto optimised = [&](double measured_x)
    {
        PoseGraph graph;
        for (int i = 0; i < 19; i++)
        {
            RelativeEdge e;
            e.from = i;
            e.to = i + 1;
            e.T_from_to.p = {1, 0.02, 0};
            e.information = informationOf(tangent(0.05, 0.005));
            graph.relative_edges.push_back(e);
        }
        chainVertices(graph, {});
        RelativeEdge closure;
        closure.from = 0;
        closure.to = 19;
        closure.kind = EdgeKind::LoopClosure;
        closure.T_from_to.p = {measured_x, 0, 0};
        closure.information = informationOf(tangent(0.01, 0.001));
        closure.information.row(0).setZero();
        closure.information.col(0).setZero();
        graph.relative_edges.push_back(closure);
        EXPECT_TRUE(optimizer->optimize(graph).converged);
        return graph;
    };
    const PoseGraph near = optimised(19), far = optimised(25);
    EXPECT_LT(difference(near, far), 1e-9);
    const Vector3d end = near.vertices.back().T_world_submap.p;
    EXPECT_NEAR(end.x(), 19, 0.01);
    EXPECT_LT(std::abs(end.y()), 0.02);  // 0.38 before

    const auto covariance = optimizer->covariance(near, {});
    const Matrix6d last = covariance->marginal(19);
    EXPECT_NEAR(last(0, 0), 19 * 0.05 * 0.05, 0.02 * 19 * 0.05 * 0.05);
    EXPECT_LT(last(1, 1), 0.01 * 0.01);
}

TEST_P(AnyGraphOptimizer, MovesWithTheWorld)
{
    Random random(9);
    const PoseGraph start = anyGraph(25, 3, false).graph;
    PoseGraph plain = start;
    optimizer->optimize(plain);
    PoseGraph moved = movedBy({expSO3({0.5, -1, 2}), {100, -50, 7}}, start);
    optimizer->optimize(moved);
    EXPECT_LT(difference(movedBy({expSO3({0.5, -1, 2}), {100, -50, 7}}, plain), moved), 1e-8);
}

TEST_P(AnyGraphOptimizer, WithGravityMovesAndTurnsAboutTheVerticalWithTheWorld)
{
    PoseGraph start = anyGraph(25, 3, true).graph;
    start.vertices[0].fixed = false;
    const Pose T{expSO3({0, 0, 2}), {100, -50, 7}};
    PoseGraph plain = start, moved = movedBy(T, start);
    EXPECT_TRUE(optimizer->optimize(plain).converged);
    EXPECT_TRUE(optimizer->optimize(moved).converged);
    EXPECT_GT(difference(start, plain), 1e-3);
    EXPECT_LT(difference(movedBy(T, plain), moved), 1e-8);
}

TEST_P(AnyGraphOptimizer, GravityLevelsRollAndPitchAndLeavesTheYaw)
{
    auto [graph, truth, none] = anyGraph(20, 7, false);
    for (RelativeEdge& e : graph.relative_edges)
        e.T_from_to = truth[e.from].inverse() * truth[e.to];
    for (std::size_t i = 0; i < truth.size(); i++)
    {
        graph.vertices[i].fixed = false;
        graph.gravity_edges.push_back(
            {static_cast<VertexId>(i), truth[i].R.transpose().col(2), 1e4 * Matrix3d::Identity()});
    }
    // Everything leans by 0.3 rad about a horizontal axis: gravity undoes that, and that alone.
    const Pose lean{expSO3({0.2, -0.22, 0}), {0, 0, 0}};
    const Pose held = lean * truth[0];
    for (std::size_t i = 0; i < truth.size(); i++)
        graph.vertices[i].T_world_submap = lean * truth[i];
    const GraphReport report = optimizer->optimize(graph);
    EXPECT_TRUE(report.converged);
    EXPECT_NEAR(report.final_cost, 0, 1e-9);
    for (std::size_t i = 0; i < truth.size(); i++)
    {
        const Pose& T = graph.vertices[i].T_world_submap;
        EXPECT_LT(logSO3(truth[i].R.transpose() * T.R).norm(), 1e-7);
        EXPECT_LT((T.p - (truth[i].p + held.p - truth[0].p)).norm(), 1e-6);
    }
}

TEST_P(AnyGraphOptimizer, HoldsTheFirstVertexWhereNoneIsFixed)
{
    PoseGraph graph = anyGraph(15, 4, false).graph;
    PoseGraph fixed = graph;
    optimizer->optimize(fixed);
    graph.vertices[0].fixed = false;
    std::rotate(graph.vertices.begin(), graph.vertices.begin() + 4, graph.vertices.end());
    optimizer->optimize(graph);
    std::rotate(graph.vertices.begin(), graph.vertices.end() - 4, graph.vertices.end());
    EXPECT_LT(difference(graph, fixed), 1e-8);
}

TEST_P(AnyGraphOptimizer, SeveralFixedVerticesStayToTheBit)
{
    PoseGraph graph = anyGraph(20, 6, true).graph;
    graph.vertices[7].fixed = graph.vertices[8].fixed = graph.vertices[15].fixed = true;
    const PoseGraph before = graph;
    EXPECT_TRUE(optimizer->optimize(graph).converged);
    for (int i : {0, 7, 8, 15})
    {
        EXPECT_EQ(graph.vertices[i].T_world_submap.R, before.vertices[i].T_world_submap.R);
        EXPECT_EQ(graph.vertices[i].T_world_submap.p, before.vertices[i].T_world_submap.p);
    }
    EXPECT_GT(difference(graph, before), 1e-3);
}

TEST_P(AnyGraphOptimizer, PartsThatNothingConnectsAreOptimisedEach)
{
    PoseGraph first = anyGraph(12, 1, false).graph, second = anyGraph(10, 2, false).graph;
    PoseGraph both = first;
    for (GraphVertex v : second.vertices)
    {
        v.id += 100;
        v.fixed = false;
        both.vertices.push_back(v);
    }
    for (RelativeEdge e : second.relative_edges)
    {
        e.from += 100;
        e.to += 100;
        both.relative_edges.push_back(e);
    }
    EXPECT_TRUE(optimizer->optimize(both).converged);
    optimizer->optimize(first);
    optimizer->optimize(second);
    const auto n = static_cast<std::ptrdiff_t>(first.vertices.size());
    PoseGraph part = both;
    part.vertices.resize(first.vertices.size());
    EXPECT_LT(difference(part, first), 1e-7);
    part.vertices.assign(both.vertices.begin() + n, both.vertices.end());
    EXPECT_LT(difference(part, second), 1e-7);
    const auto covariance = optimizer->covariance(both, {});
    EXPECT_THROW(covariance->relative(3, 105), std::invalid_argument);
    EXPECT_NO_THROW(covariance->relative(103, 105));
}

TEST_P(AnyGraphOptimizer, APartThatLosesItsOnlyTiesGoesBackToWhereItWas)
{
    // Two chains, and two closures between them that cannot both be true.
    PoseGraph graph;
    for (int i = 0; i < 8; i++)
        graph.vertices.push_back(
            {i, {Matrix3d::Identity(), {1.0 * i, i < 4 ? 0.0 : 50.0, 0}}, false});
    const auto tie = [&](int from, int to, const Vector3d& p, EdgeKind kind)
    {
        RelativeEdge e;
        e.from = from;
        e.to = to;
        e.kind = kind;
        e.T_from_to.p = p;
        e.information = informationOf(tangent(0.1, 0.1));
        graph.relative_edges.push_back(e);
    };
    for (int i : {0, 1, 2, 4, 5, 6}) tie(i, i + 1, {1, 0, 0}, EdgeKind::Odometry);
    const PoseGraph before = graph;
    tie(1, 5, {0, 0, 30}, EdgeKind::LoopClosure);
    tie(1, 5, {0, 0, -30}, EdgeKind::LoopClosure);
    const GraphReport report = optimizer->optimize(graph);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.weights[6], 0);
    EXPECT_EQ(report.weights[7], 0);
    EXPECT_LT(difference(graph, before), 1e-9);
}

TEST_P(AnyGraphOptimizer, FalseClosuresAreRefusedAndTrueOnesKept)
{
    GraphWithTruth laps = twoLaps(200, 3);
    falsify(laps, 0.3, 3);
    ASSERT_EQ(laps.false_closures.size(), 30u);
    PoseGraph clean = laps.graph;
    for (std::size_t i : laps.false_closures) clean.relative_edges[i].enabled = false;

    const GraphReport report = optimizer->optimize(laps.graph);
    EXPECT_TRUE(report.converged);
    for (std::size_t i : laps.false_closures) EXPECT_LT(report.weights[i], 0.01);
    for (std::size_t i = 0; i < 199; i++) ASSERT_EQ(report.weights[i], 1);
    optimizer->optimize(clean);
    EXPECT_LT(difference(laps.graph, clean), 0.05);  // less than the deviation of a closure

    // One true closure lies at the bound by its noise. With the same verdict on it, the results are
    // the same.
    EXPECT_EQ(trueClosuresRefused(laps, report), 1);
    for (std::size_t i = 0; i < report.weights.size(); i++)
        clean.relative_edges[i].enabled = report.weights[i] == 1;
    optimizer->optimize(clean);
    EXPECT_LT(difference(laps.graph, clean), 1e-6);
}

TEST_P(AnyGraphOptimizer, WithoutRobustWeightsFalseClosuresTearTheGraphApart)
{
    GraphWithTruth laps = twoLaps(60, 1);
    falsify(laps, 0.3, 1);
    PoseGraph plain = laps.graph;
    const GraphReport report = makeOptimizer(GetParam(), "{robust: false}")->optimize(plain);
    EXPECT_THAT(report.weights, ::testing::Each(1.0));
    EXPECT_GT(report.final_cost, 1e4);
    optimizer->optimize(laps.graph);
    EXPECT_GT(difference(plain, laps.graph), 1);
}

TEST_P(AnyGraphOptimizer, OdometryAndGravityAreNeverDoubted)
{
    PoseGraph graph = twoLaps(40, 1).graph;
    graph.relative_edges[20].T_from_to.p += Vector3d(5, 0, 0);
    graph.gravity_edges.push_back({10, Vector3d::UnitX(), 1e6 * Matrix3d::Identity()});
    const GraphReport report = optimizer->optimize(graph);
    for (std::size_t i = 0; i < 39; i++) EXPECT_EQ(report.weights[i], 1);
    EXPECT_LT(report.gravity_chi2[0], 1e4);  // of 2e6 at the start: it has pulled
}

TEST_P(AnyGraphOptimizer, EdgesThatAreNotEnabledDoNotPull)
{
    PoseGraph graph = anyGraph(20, 2, true).graph, without = graph;
    RelativeEdge e = graph.relative_edges.back();
    e.enabled = false;
    e.T_from_to.p += Vector3d(3, 3, 3);
    graph.relative_edges.push_back(e);
    const GraphReport report = optimizer->optimize(graph);
    optimizer->optimize(without);
    EXPECT_LT(difference(graph, without), 1e-12);
    EXPECT_EQ(report.weights.back(), 0);
    EXPECT_GT(report.relative_chi2.back(), 100);  // and yet the report says how it fits
}

TEST_P(AnyGraphOptimizer, TheOrderOfTheEdgesDoesNotMatter)
{
    GraphWithTruth laps = twoLaps(60, 4);
    falsify(laps, 0.2, 4);
    PoseGraph shuffled = laps.graph;
    std::mt19937_64 engine(1);
    std::shuffle(shuffled.relative_edges.begin(), shuffled.relative_edges.end(), engine);
    std::reverse(shuffled.vertices.begin(), shuffled.vertices.end());
    optimizer->optimize(laps.graph);
    optimizer->optimize(shuffled);
    std::reverse(shuffled.vertices.begin(), shuffled.vertices.end());
    EXPECT_LT(difference(laps.graph, shuffled), 1e-9);
}

TEST_P(AnyGraphOptimizer, RepeatsToTheBit)
{
    GraphWithTruth laps = twoLaps(60, 2);
    falsify(laps, 0.2, 2);
    laps.graph.gravity_edges.push_back({3, Vector3d::UnitZ(), Matrix3d::Identity()});
    PoseGraph again = laps.graph;
    const GraphReport a = optimizer->optimize(laps.graph), b = optimizer->optimize(again);
    for (std::size_t i = 0; i < again.vertices.size(); i++)
    {
        const Pose &x = laps.graph.vertices[i].T_world_submap,
                   &y = again.vertices[i].T_world_submap;
        EXPECT_EQ(std::memcmp(x.R.data(), y.R.data(), sizeof x.R), 0);
        EXPECT_EQ(std::memcmp(x.p.data(), y.p.data(), sizeof x.p), 0);
    }
    EXPECT_EQ(a.final_cost, b.final_cost);
    EXPECT_EQ(a.relative_chi2, b.relative_chi2);
}

TEST_P(AnyGraphOptimizer, HalfTurnsAndDuplicateEdgesAreEdgesLikeOthers)
{
    std::vector<Pose> truth(8);
    for (std::size_t i = 1; i < truth.size(); i++)
        truth[i] = truth[i - 1] *
                   Pose{expSO3(M_PI * Vector3d::Unit(static_cast<int>(i % 3))), {1, 0.5, 0}};
    Random random(8);
    PoseGraph graph;
    for (int i = 0; i < 7; i++)
        graph.relative_edges.push_back(
            measured(truth, i, i + 1, EdgeKind::Odometry, tangent(0.02, 0.02), random));
    chainVertices(graph, truth[0]);
    graph.relative_edges.push_back(
        measured(truth, 7, 0, EdgeKind::LoopClosure, tangent(0.01, 0.01), random));
    PoseGraph twice = graph;
    graph.relative_edges.back().information *= 2;
    twice.relative_edges.push_back(twice.relative_edges.back());
    for (std::size_t i = 1; i < 8; i++)
        twice.vertices[i].T_world_submap.R *= expSO3(random.vector(0.3));
    EXPECT_TRUE(optimizer->optimize(graph).converged);
    EXPECT_TRUE(optimizer->optimize(twice).converged);
    EXPECT_LT(difference(graph, twice), 1e-7);
    for (std::size_t i = 1; i < 8; i++)
        EXPECT_LT(logSO3(truth[i].R.transpose() * graph.vertices[i].T_world_submap.R).norm(), 0.1);
}

TEST_P(AnyGraphOptimizer, CovarianceIsTheInverseOfTheHessian)
{
    for (bool gravity : {false, true})
    {
        PoseGraph graph = anyGraph(14, 11, gravity).graph;
        optimizer->optimize(graph);
        const auto covariance = optimizer->covariance(graph, {});
        const Eigen::MatrixXd H = numericHessian(graph);
        const Eigen::Index n = H.rows() - 6;  // without the first, which is fixed
        const Eigen::MatrixXd inverse =
            H.bottomRightCorner(n, n).ldlt().solve(Eigen::MatrixXd::Identity(n, n));
        const auto block = [&](int a, int b) { return inverse.block<6, 6>(6 * a - 6, 6 * b - 6); };
        EXPECT_TRUE(covariance->marginal(0).isZero(0));
        for (int i = 1; i < 14; i++)
            EXPECT_LT((covariance->marginal(i) - block(i, i)).norm(), 1e-6 * block(i, i).norm());
        const auto joint = covariance->joint(3, 12);
        GraphCovariance::Matrix12d expected;
        expected << block(3, 3), block(3, 12), block(12, 3), block(12, 12);
        EXPECT_LT((joint - expected).norm(), 1e-6 * expected.norm());

        const auto pose = [&](int i) { return graph.vertices[i].T_world_submap; };
        const Pose between = pose(3).inverse() * pose(12);
        const auto J = numericJacobian(
            [&](const Eigen::VectorXd& d)
            {
                return relativeResidual(
                    between, perturbed(pose(3), d.head<6>()), perturbed(pose(12), d.tail<6>()));
            },
            12);
        const Eigen::MatrixXd relative = J * expected * J.transpose();
        EXPECT_LT((covariance->relative(3, 12) - relative).norm(), 1e-6 * relative.norm());
    }
}

TEST_P(AnyGraphOptimizer, CovarianceOfOneEdgeIsThatOfItsMeasurement)
{
    Random random(5);
    PoseGraph graph;
    graph.vertices = {{4, anyPose(random, 2, 1), false}, {9, {}, false}};
    RelativeEdge e;
    e.from = 4;
    e.to = 9;
    e.T_from_to = anyPose(random, 2, 1);
    e.information = anyInformation<6>(random);
    graph.relative_edges = {e};
    graph.vertices[1].T_world_submap = graph.vertices[0].T_world_submap * e.T_from_to;
    const Matrix6d covariance = optimizer->covariance(graph, {})->relative(4, 9);
    EXPECT_LT((covariance * e.information - Matrix6d::Identity()).norm(), 1e-7);
    // With half the weight it is twice as large.
    const Matrix6d half = optimizer->covariance(graph, {0.5})->relative(4, 9);
    EXPECT_LT((half - 2 * covariance).norm(), 1e-7 * half.norm());
}

TEST_P(AnyGraphOptimizer, RelativeCovarianceDoesNotDependOnWhatIsHeld)
{
    PoseGraph graph = anyGraph(14, 12, true).graph;
    optimizer->optimize(graph);
    for (GraphVertex& v : graph.vertices) v.fixed = false;
    const Matrix6d relative = optimizer->covariance(graph, {})->relative(4, 10);
    // The same graph, its vertex of lowest id, which keeps position and yaw, another one.
    PoseGraph renamed = graph;
    const auto swapped = [](VertexId id) { return id == 0 ? 6 : id == 6 ? 0 : id; };
    for (GraphVertex& v : renamed.vertices) v.id = swapped(v.id);
    for (RelativeEdge& e : renamed.relative_edges)
    {
        e.from = swapped(e.from);
        e.to = swapped(e.to);
    }
    for (GravityEdge& e : renamed.gravity_edges) e.vertex = swapped(e.vertex);
    const Matrix6d other = optimizer->covariance(renamed, {})->relative(4, 10);
    EXPECT_LT((relative - other).norm(), 1e-6 * relative.norm());
}

TEST(PoseGraphGauge, SixDirectionsAreOpenWithoutGravityAndFourWithIt)
{
    for (bool gravity : {false, true})
    {
        const PoseGraph graph = anyGraph(8, 3, gravity).graph;
        const Eigen::VectorXd eigenvalues =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(numericHessian(graph)).eigenvalues();
        const auto open = (eigenvalues.array() < 1e-6 * eigenvalues.maxCoeff()).count();
        // Away from the optimum, gravity is curved: its Gauss-Newton Hessian is blind to yaw alone.
        EXPECT_EQ(open, gravity ? 4 : 6);
    }
}

TEST_P(AnyGraphOptimizer, OpenDirectionsStayWhereTheyAreAndHaveNoCovariance)
{
    PoseGraph graph = anyGraph(6, 3, false).graph;
    graph.relative_edges.resize(5);
    graph.relative_edges[4].information.setZero();
    graph.relative_edges[4].information(1, 1) = 100;  // the last vertex is known along one axis
    graph.vertices[5].T_world_submap.p += graph.vertices[5].T_world_submap.R * Vector3d(1, 1, 1);
    graph.vertices[5].T_world_submap.R *= expSO3({0.1, 0, 0});
    const PoseGraph before = graph;
    const GraphReport report = optimizer->optimize(graph);
    EXPECT_TRUE(report.converged);
    EXPECT_NEAR(report.final_cost, 0, 1e-12);
    // It was off by one metre along the axis that is known, and goes back along that one alone.
    const Vector3d gone = before.vertices[5].T_world_submap.p - graph.vertices[5].T_world_submap.p;
    const Matrix3d R_known =
        graph.vertices[4].T_world_submap.R * graph.relative_edges[4].T_from_to.R;
    EXPECT_LT((R_known.transpose() * gone - Vector3d(0, 1, 0)).norm(), 0.02);
    EXPECT_LT(
        logSO3(before.vertices[5].T_world_submap.R.transpose() * graph.vertices[5].T_world_submap.R)
            .norm(),
        1e-6);
    EXPECT_THROW(optimizer->covariance(graph, {}), std::runtime_error);
}

TEST_P(AnyGraphOptimizer, SaysWhatIsWrongWithABadGraphAndLeavesIt)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    struct Fault
    {
        const char* message;
        std::function<void(PoseGraph&)> make;
    };
    const std::vector<Fault> faults{
        {"vertex 77: is unknown", [](PoseGraph& g) { g.relative_edges[3].to = 77; }},
        {"vertex 78: is unknown", [](PoseGraph& g) { g.gravity_edges[2].vertex = 78; }},
        {"vertex 4: is given twice", [](PoseGraph& g) { g.vertices[5].id = 4; }},
        {"edge 2 -> 2: both ends", [](PoseGraph& g) { g.relative_edges[2].to = 2; }},
        {"vertex 5: its pose is not finite",
         [&](PoseGraph& g) { g.vertices[5].T_world_submap.p[1] = nan; }},
        {"vertex 5: its rotation is not a rotation matrix",
         [](PoseGraph& g) { g.vertices[5].T_world_submap.R *= 1.01; }},
        {"edge 3 -> 4: its pose is not finite",
         [&](PoseGraph& g) { g.relative_edges[3].T_from_to.R(0, 0) = nan; }},
        {"edge 3 -> 4: its rotation is not a rotation matrix",
         [](PoseGraph& g) { g.relative_edges[3].T_from_to.R *= -1; }},
        {"edge 3 -> 4: its information is not finite",
         [&](PoseGraph& g) { g.relative_edges[3].information(2, 2) = nan; }},
        {"edge 3 -> 4: its information is not symmetric",
         [](PoseGraph& g) { g.relative_edges[3].information(2, 1) += 1; }},
        {"edge 3 -> 4: its information is not positive semi-definite",
         [](PoseGraph& g) { g.relative_edges[3].information(2, 2) = -1; }},
        {"edge 3 -> 4: its information is not positive semi-definite",
         [](PoseGraph& g)
         {
             // Its diagonal is positive, and so are five of its eigenvalues.
             g.relative_edges[3].information.setIdentity();
             g.relative_edges[3].information(0, 5) = g.relative_edges[3].information(5, 0) = 1.001;
         }},
        {"edge 3 -> 4: its information is not positive semi-definite",
         [](PoseGraph& g)
         {
             g.relative_edges[3].information.setIdentity();
             g.relative_edges[3].information(0, 0) = 0;
             g.relative_edges[3].information(0, 1) = g.relative_edges[3].information(1, 0) = 0.1;
         }},
        {"gravity of vertex 2: up_submap is not a unit vector",
         [](PoseGraph& g) { g.gravity_edges[2].up_submap *= 9.81; }},
        {"gravity of vertex 2: its information is not positive semi-definite",
         [](PoseGraph& g) { g.gravity_edges[2].information *= -1; }}};
    for (const Fault& fault : faults)
    {
        PoseGraph graph = anyGraph(8, 1, true).graph;
        fault.make(graph);
        const PoseGraph before = graph;
        try
        {
            optimizer->optimize(graph);
            ADD_FAILURE() << "accepted: " << fault.message;
        }
        catch (const std::invalid_argument& e)
        {
            EXPECT_THAT(e.what(), ::testing::HasSubstr(fault.message));
        }
        EXPECT_EQ(graph.vertices[3].T_world_submap.p, before.vertices[3].T_world_submap.p);
        EXPECT_THROW(optimizer->covariance(graph, {}), std::invalid_argument);
    }
    const PoseGraph good = anyGraph(8, 1, true).graph;
    EXPECT_THROW(optimizer->covariance(good, {1, 1}), std::invalid_argument);
    EXPECT_THROW(optimizer->covariance(good, {})->marginal(77), std::invalid_argument);
}

TEST_P(AnyGraphOptimizer, GraphsWithNothingToDoAreDone)
{
    PoseGraph empty;
    EXPECT_TRUE(optimizer->optimize(empty).converged);
    PoseGraph alone;
    alone.vertices = {{7, {Matrix3d::Identity(), {1, 2, 3}}, false}};
    EXPECT_TRUE(optimizer->optimize(alone).converged);
    EXPECT_EQ(alone.vertices[0].T_world_submap.p, Vector3d(1, 2, 3));
    EXPECT_TRUE(optimizer->covariance(alone, {})->marginal(7).isZero(0));
    PoseGraph exact = twoLaps(20, 1).graph;
    exact.relative_edges.resize(19);  // odometry alone: the vertices are where it says
    const PoseGraph before = exact;
    EXPECT_TRUE(optimizer->optimize(exact).converged);
    EXPECT_LT(difference(exact, before), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(
    Graph, AnyGraphOptimizer,
    ::testing::Values("taut::SparseGraphOptimizer", "taut::DenseGraphOptimizer"),
    [](const auto& choice) { return std::string(choice.param).substr(6); });

TEST(GraphOptimizers, AgreeOnEveryGraph)
{
    const auto sparse = makeOptimizer("taut::SparseGraphOptimizer");
    const auto dense = makeOptimizer("taut::DenseGraphOptimizer");
    for (unsigned seed = 1; seed <= 6; seed++)
    {
        GraphWithTruth graph = seed % 2 == 0 ? twoLaps(50, seed) : anyGraph(40, seed, seed > 2);
        if (seed % 2 == 0) falsify(graph, 0.1 * seed, seed);
        if (seed == 3) graph.graph.vertices[0].fixed = false;
        PoseGraph a = graph.graph, b = graph.graph;
        const GraphReport x = sparse->optimize(a), y = dense->optimize(b);
        EXPECT_TRUE(x.converged && y.converged) << seed;
        EXPECT_LT(difference(a, b), 1e-6) << seed;
        EXPECT_EQ(x.weights, y.weights) << seed;
        EXPECT_NEAR(x.final_cost, y.final_cost, 1e-6 * (1 + y.final_cost));
        EXPECT_NEAR(x.initial_cost, y.initial_cost, 1e-9 * y.initial_cost);
        for (std::size_t i = 0; i < x.relative_chi2.size(); i++)
            EXPECT_NEAR(x.relative_chi2[i], y.relative_chi2[i], 1e-4 * (1 + y.relative_chi2[i]));
        const Matrix6d cov = sparse->covariance(a, x.weights)->marginal(20);
        EXPECT_LT((cov - dense->covariance(b, y.weights)->marginal(20)).norm(), 1e-4 * cov.norm());
    }
}

TEST(SparseGraphOptimizer, TheOrderOfVerticesAndEdgesDoesNotChangeABit)
{
    const auto optimizer = makeOptimizer("taut::SparseGraphOptimizer");
    GraphWithTruth laps = twoLaps(100, 3);
    falsify(laps, 0.2, 3);
    PoseGraph shuffled = laps.graph;
    std::mt19937_64 engine(5);
    std::shuffle(shuffled.relative_edges.begin(), shuffled.relative_edges.end(), engine);
    std::reverse(shuffled.vertices.begin(), shuffled.vertices.end());
    optimizer->optimize(laps.graph);
    optimizer->optimize(shuffled);
    std::reverse(shuffled.vertices.begin(), shuffled.vertices.end());
    EXPECT_EQ(difference(laps.graph, shuffled), 0);
}

TEST(SparseGraphOptimizer, UpToHalfOfTheClosuresMayBeFalse)
{
    const auto optimizer = makeOptimizer("taut::SparseGraphOptimizer");
    int true_closures = 0, refused = 0;
    for (unsigned seed = 1; seed <= 40; seed++)
    {
        GraphWithTruth laps = twoLaps(100, seed);
        falsify(laps, seed % 2 == 0 ? 0.3 : 0.5, seed);
        const GraphReport report = optimizer->optimize(laps.graph);
        EXPECT_TRUE(report.converged);
        for (std::size_t i : laps.false_closures) EXPECT_EQ(report.weights[i], 0) << seed;
        refused += trueClosuresRefused(laps, report);
        true_closures += 50 - static_cast<int>(laps.false_closures.size());
    }
    // The bound is that of 99 %: five standard deviations of the count.
    EXPECT_LT(refused, 0.01 * true_closures + 5 * std::sqrt(0.01 * true_closures));
}

TEST(SparseGraphOptimizer, ATrueClosureThatOnlyItsRefusalPutsBeyondTheBoundIsHeardAgain)
{
    const auto optimizer = makeOptimizer("taut::SparseGraphOptimizer");
    for (unsigned seed : {4, 9, 59})
    {
        GraphWithTruth laps = twoLaps(60, seed);
        falsify(laps, 0.1, seed);
        EXPECT_EQ(trueClosuresRefused(laps, optimizer->optimize(laps.graph)), 0) << seed;
    }
}
