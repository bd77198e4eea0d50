#include "taut/slam/Mapper.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "taut/core/format.h"
#include "taut/files/PlyFile.h"
#include "taut/loops/SubmapRegistration.h"
#include "taut/slam/ClosureGate.h"
#include "taut/slam/DriftScale.h"
#include "taut/slam/PathCorrection.h"

namespace taut
{
namespace
{
constexpr std::size_t kMaps = 12;    // of submaps, kept in memory
constexpr int kRounds = 4;           // over the whole graph in the end
constexpr double kBeyond = 0.0027;   // of true gaps are as large as one that is not believed alone
constexpr double kEdgeTorn = 1e-6;   // likelihood of an edge, below which a loop tears it
constexpr VertexId kNeighbours = 6;  // submaps along the path that two loops may be apart

/** Adds the time of its life to a sum. */
class Watch
{
 public:
    explicit Watch(double& seconds) : seconds_(seconds), begin_(std::chrono::steady_clock::now()) {}
    ~Watch()
    {
        seconds_ +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

 private:
    double& seconds_;
    std::chrono::steady_clock::time_point begin_;
};

/** Where the odometry has the next submap. */
Pose nextInFrameOf(const Submap& submap, const Submap& next)
{
    return submap.last().T_submap_imu * next.scans.front().T_submap_imu.inverse();
}

/** What two loops say together of a circle: in directions that both show. */
Matrix6d harmonicSum(const Matrix6d& a, const Matrix6d& b)
{
    // (a^-1 + b^-1)^-1 = a (a + b)^-1 b, which holds where one of them is singular, too.
    const Matrix6d sum = a * (a + b).completeOrthogonalDecomposition().solve(b);
    return 0.5 * (sum + sum.transpose());
}

RelativeEdge odometryEdge(const Submap& from, const Submap& to)
{
    RelativeEdge edge;
    edge.from = from.id;
    edge.to = to.id;
    edge.T_from_to = nextInFrameOf(from, to);
    const Matrix6d to_right = rightFromLeft(edge.T_from_to);
    const Matrix6d covariance = to_right * from.last().covariance * to_right.transpose();
    const Matrix6d information = covariance.ldlt().solve(Matrix6d::Identity());
    edge.information = 0.5 * (information + information.transpose());
    return edge;
}
}  // namespace

Mapper::Mapper(const SlamConfig& config, std::string folder, Executor& executor, WarningSink warn)
    : config_(config),
      executor_(executor),
      warn_(std::move(warn)),
      store_(std::move(folder)),
      places_(config.places.create()),
      optimizer_(config.optimizer.create()),
      judge_(config.judge, executor),
      builder_(config.submap, [this](Submap submap) { take(std::move(submap)); })
{
}

void Mapper::take(Submap submap)
{
    const Watch watch(seconds_);
    const VertexId id = submap.id;
    Pose T_world_submap = submap.T_world_submap;
    if (!graph_.vertices.empty())
    {
        const auto before = store_.at(graph_.vertices.back().id);
        graph_.relative_edges.push_back(odometryEdge(*before, submap));
        T_world_submap =
            graph_.vertices.back().T_world_submap * graph_.relative_edges.back().T_from_to;
        weights_.push_back(1);
    }
    graph_.vertices.push_back({id, T_world_submap, graph_.vertices.empty()});
    const Matrix3d tilt = submap.up_covariance.ldlt().solve(Matrix3d::Identity());
    graph_.gravity_edges.push_back({id, submap.up_submap, 0.5 * (tilt + tilt.transpose())});
    covariance_.reset();
    places_->add(submap);
    store_.add(std::move(submap));
    searchFor(id);
    weighPending();
}

void Mapper::finish()
{
    builder_.finish();
    const Watch watch(seconds_);
    for (int round = 0; round < kRounds; round++)
    {
        const std::size_t judged = loops_.size(), accepted = accepted_;
        for (std::size_t i = 0; i < graph_.vertices.size(); i++) searchFor(graph_.vertices[i].id);
        weighPending();
        learnDrift();
        if (round > 0 && loops_.size() == judged && accepted_ == accepted) break;
    }
    for (LoopClosure& loop : loops_)
        if (loop.verdict == Verdict::Pending)
            loop.reason = format(
                "the gap is unlikely (chi2 %.0f) and no second loop agrees", loop.evidence.chi2);
}

const Pose& Mapper::poseOf(VertexId id) const
{
    return graph_.vertices[static_cast<std::size_t>(graph_.indexOf(id))].T_world_submap;
}

Pose Mapper::between(VertexId from, VertexId to) const
{
    return poseOf(from).inverse() * poseOf(to);
}

SubmapView Mapper::viewOf(VertexId id)
{
    const auto submap = store_.at(id);
    const auto found =
        std::find_if(maps_.begin(), maps_.end(), [id](const auto& m) { return m.first == id; });
    if (found != maps_.end())
    {
        maps_.splice(maps_.begin(), maps_, found);
    }
    else
    {
        auto map = config_.map.create();
        map->insert(mapPointsOf(*submap, submap->points.size()), executor_);
        maps_.emplace_front(id, std::move(map));
        if (maps_.size() > kMaps) maps_.pop_back();
    }
    return {submap, maps_.front().second};
}

std::optional<Matrix6d> Mapper::covarianceOf(VertexId from, VertexId to)
{
    if (!covariance_) covariance_ = optimizer_->covariance(graph_, weights_);
    try
    {
        return covariance_->relative(from, to);
    }
    catch (const std::invalid_argument&)  // nothing joins them
    {
        return {};
    }
}

void Mapper::searchFor(VertexId id)
{
    const PlaceKnowledge knowledge{
        graph_, [this](VertexId from, VertexId to) { return covarianceOf(from, to); }};
    for (const LoopCandidate& candidate : places_->candidates(id, knowledge))
        if (judged_.insert({candidate.from, candidate.to}).second) judge(candidate);
}

void Mapper::judge(const LoopCandidate& candidate)
{
    loops_.push_back(judge_.judge(candidate, viewOf(candidate.from), viewOf(candidate.to)));
}

bool Mapper::agrees(const LoopClosure& a, const LoopClosure& b) const
{
    // Round the small circle that both loops make with the path beside them.
    if (a.from == b.from && a.to == b.to) return false;
    if (std::abs(a.from - b.from) > kNeighbours || std::abs(a.to - b.to) > kNeighbours)
        return false;
    const Pose there = a.T_from_to * between(a.to, b.to);
    const Pose back = between(a.from, b.from) * b.T_from_to;
    Matrix6d covariance = Matrix6d::Zero();
    for (const RelativeEdge& edge : graph_.relative_edges)
    {
        if (edge.kind != EdgeKind::Odometry) continue;
        const auto lies_between = [&edge](VertexId x, VertexId y)
        { return edge.from >= std::min(x, y) && edge.to <= std::max(x, y); };
        if (!lies_between(a.from, b.from) && !lies_between(a.to, b.to)) continue;
        covariance += edge.information.ldlt().solve(Matrix6d::Identity());
    }
    const Vector6d gap = rightErrorTo(there, back);
    return testGap(gap, covariance, harmonicSum(a.information, b.information)).isWithin(kBeyond);
}

void Mapper::weighPending()
{
    bool changed = true;
    while (changed)
    {
        changed = false;
        for (LoopClosure& loop : loops_)
        {
            if (loop.verdict != Verdict::Pending) continue;
            const std::optional<Matrix6d> covariance = covarianceOf(loop.from, loop.to);
            if (!covariance) continue;
            const Vector6d gap = rightErrorTo(between(loop.from, loop.to), loop.T_from_to);
            const GapTest test = testGap(gap, *covariance, loop.information);
            loop.evidence.chi2 = test.chi2;
            loop.evidence.gap = gap.head<3>().norm();
            loop.evidence.gap_angle = gap.tail<3>().norm();
            std::string reason = "the gap is likely by the graph";
            bool is_believed = test.isWithin(kBeyond);
            for (const LoopClosure& other : loops_)
            {
                if (is_believed) break;
                if (other.verdict != Verdict::Pending) continue;
                is_believed = agrees(loop, other);
                reason = format(
                    "the loop from %lld to %lld agrees", static_cast<long long>(other.from),
                    static_cast<long long>(other.to));
            }
            if (!is_believed) continue;
            accept(loop, reason);
            changed = true;
        }
    }
}

void Mapper::accept(LoopClosure& loop, const std::string& reason)
{
    const PoseGraph before = graph_;
    const std::vector<double> weights_before = weights_;
    RelativeEdge edge;
    edge.from = loop.from;
    edge.to = loop.to;
    edge.T_from_to = loop.T_from_to;
    edge.information = loop.information;
    edge.kind = EdgeKind::LoopClosure;
    graph_.relative_edges.push_back(edge);
    const GraphReport report = optimizer_->optimize(graph_);
    weights_ = report.weights;
    covariance_.reset();

    // Nothing that is known for certain may be torn by it.
    const double torn = chiSquareBeyond(kEdgeTorn, 6);
    bool fits = report.converged && report.weights.back() > 0.5;
    for (std::size_t i = 0; i < report.relative_chi2.size(); i++)
        if (graph_.relative_edges[i].kind == EdgeKind::Odometry && report.relative_chi2[i] > torn)
            fits = false;
    for (const double chi2 : report.gravity_chi2) fits = fits && chi2 < torn;
    loop.reason = reason;
    if (fits)
    {
        loop.verdict = Verdict::Accepted;
        accepted_++;
        return;
    }
    loop.verdict = Verdict::Withdrawn;
    loop.reason = "it would tear what is known better";
    graph_ = before;
    weights_ = weights_before;
    if (warn_)
        warn_(
            {0, "loop_withdrawn",
             format(
                 "the loop from submap %lld to %lld would tear what is known better",
                 static_cast<long long>(loop.from), static_cast<long long>(loop.to))});
}

PoseGraph Mapper::odometryAlone() const
{
    PoseGraph alone = graph_;
    for (RelativeEdge& edge : alone.relative_edges) edge.enabled = edge.kind == EdgeKind::Odometry;
    for (std::size_t i = 1; i < alone.vertices.size(); i++)
    {
        const auto before = store_.at(alone.vertices[i - 1].id);
        alone.vertices[i].T_world_submap = alone.vertices[i - 1].T_world_submap *
                                           nextInFrameOf(*before, *store_.at(alone.vertices[i].id));
    }
    return alone;
}

void Mapper::learnDrift()
{
    const PoseGraph alone = odometryAlone();
    std::vector<ClosedGap> gaps;
    std::shared_ptr<const GraphCovariance> covariance;
    for (const LoopClosure& loop : loops_)
    {
        if (loop.verdict != Verdict::Accepted) continue;
        if (!covariance) covariance = optimizer_->covariance(alone, {});
        const Pose T_from_to =
            alone.vertices[static_cast<std::size_t>(alone.indexOf(loop.from))]
                .T_world_submap.inverse() *
            alone.vertices[static_cast<std::size_t>(alone.indexOf(loop.to))].T_world_submap;
        gaps.push_back(
            {rightErrorTo(T_from_to, loop.T_from_to),
             covariance->relative(loop.from, loop.to) / drift_scale_, loop.information});
    }
    if (gaps.empty()) return;
    const double scale = driftScale(gaps);
    for (RelativeEdge& edge : graph_.relative_edges)
        if (edge.kind == EdgeKind::Odometry) edge.information *= drift_scale_ / scale;
    drift_scale_ = scale;
    weights_ = optimizer_->optimize(graph_).weights;
    covariance_.reset();
}

void Mapper::forPath(const std::function<void(Time, const Pose&)>& visit) const
{
    for (std::size_t i = 0; i < graph_.vertices.size(); i++)
    {
        const GraphVertex& vertex = graph_.vertices[i];
        const auto submap = store_.at(vertex.id);
        std::vector<Pose> poses;
        if (i + 1 < graph_.vertices.size())
        {
            const GraphVertex& next = graph_.vertices[i + 1];
            poses = correctedPoses(
                *submap, vertex.T_world_submap, nextInFrameOf(*submap, *store_.at(next.id)),
                next.T_world_submap);
        }
        else
        {
            poses = correctedPoses(*submap, vertex.T_world_submap);
        }
        // The first state is the last of the submap before.
        for (std::size_t k = i == 0 ? 0 : 1; k < poses.size(); k++)
            visit(submap->scans[k].t, poses[k]);
    }
}

std::vector<std::pair<Vector3d, Vector3d>> Mapper::joinedPlaces() const
{
    std::vector<std::pair<Vector3d, Vector3d>> places;
    for (const LoopClosure& loop : loops_)
        if (loop.verdict == Verdict::Accepted)
            places.emplace_back(poseOf(loop.from).p, poseOf(loop.to).p);
    return places;
}

void Mapper::writeClouds() const
{
    for (const GraphVertex& vertex : graph_.vertices)
    {
        const std::string name = store_.fileOf(vertex.id);
        PlyPointWriter file(name.substr(0, name.size() - 4) + ".ply");
        for (const SubmapPoint& p : store_.at(vertex.id)->points)
        {
            const Vector3d in_world = vertex.T_world_submap * Vector3d(p.position.cast<double>());
            file.append({in_world.cast<float>(), 0});
        }
        file.close();
    }
}
}  // namespace taut
