#include "taut/slam/Mapper.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "taut/core/format.h"
#include "taut/files/PlyFile.h"
#include "taut/graph/G2oFile.h"
#include "taut/loops/SubmapRegistration.h"
#include "taut/slam/ClosureGate.h"
#include "taut/slam/PathCorrection.h"
#include "taut/submaps/SubmapFile.h"

namespace fs = std::filesystem;

namespace taut
{
namespace
{
constexpr std::size_t kMaps = 12;           // of submaps, kept in memory
constexpr double kBetweenRecordings = 1e5;  // [m] on the way from one recording to the next
constexpr int kRounds = 4;                  // over the whole graph in the end
constexpr double kBeyond = 0.0027;  // of true gaps are as large as one that is not believed alone
constexpr double kGapsByChance = 0.01;  // of runs without drift have gaps as large
constexpr double kEdgeTorn = 1e-6;      // likelihood of an edge, below which a loop tears it

// Two joints say the same of where the run is in the map.
constexpr double kJointApart = 0.5;    // [m]
constexpr double kJointTurned = 0.03;  // [rad]
/** Share of conflicts that makes a joint worth 1/e: places that look alike differ by more. */
constexpr double kTellingConflicts = 0.002;
constexpr double kClearly = 3;  // times the evidence of the second best

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

/** Of a vertex that is there; ids ascend in the graphs here. */
const Pose& poseIn(const PoseGraph& graph, VertexId id)
{
    return std::lower_bound(
               graph.vertices.begin(), graph.vertices.end(), id,
               [](const GraphVertex& v, VertexId wanted) { return v.id < wanted; })
        ->T_world_submap;
}

/** Of the results in a folder. */
PoseGraph readGraph(const std::string& folder)
{
    PoseGraph graph = readG2o((fs::path(folder) / "graph.g2o").string());
    const auto ascending = [](const GraphVertex& a, const GraphVertex& b) { return a.id < b.id; };
    if (!std::is_sorted(graph.vertices.begin(), graph.vertices.end(), ascending))
        throw std::runtime_error("the map in '" + folder + "' is none of taut's");
    if (graph.vertices.empty())
        throw std::runtime_error("the map in '" + folder + "' has no submaps");
    return graph;
}

std::string submapFile(const std::string& folder, VertexId id)
{
    return (fs::path(folder) / "submaps" / format("%05lld.tsm", static_cast<long long>(id)))
        .string();
}

/** Of the results in a folder. */
Submap readSubmapOf(const std::string& folder, VertexId id)
{
    Submap submap = readSubmap(submapFile(folder, id));
    if (submap.id != id)
        throw std::runtime_error(
            "'" + submapFile(folder, id) + "' is another submap than its name says");
    return submap;
}

/** Where the odometry has the next submap. */
Pose nextInFrameOf(const Submap& submap, const Submap& next)
{
    return submap.last().T_submap_imu * next.scans.front().T_submap_imu.inverse();
}

/** Of T_from_to; directions that the loop does not show are anywhere. */
Matrix6d covarianceOfLoop(const LoopClosure& loop)
{
    constexpr double kAnywhere = 1e4;  // [m^2]
    const ShownDirections shown = shownDirections(loop.information);
    const Matrix6d open = Matrix6d::Identity() - shown.basis * shown.basis.transpose();
    return shown.basis * shown.information.cwiseInverse().asDiagonal() * shown.basis.transpose() +
           kAnywhere * open;
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
      store_(folder),
      folder_(std::move(folder)),
      places_(config.places.create()),
      appearance_(config.appearance.create()),
      optimizer_(config.optimizer.create()),
      judge_(config.judge, executor),
      builder_(config.submap, [this](Submap submap) { take(std::move(submap)); })
{
}

void Mapper::use(const KnownMap& map)
{
    PoseGraph known = readGraph(map.folder);
    known_ = map;
    for (GraphVertex& vertex : known.vertices)
    {
        const Submap submap = readSubmapOf(map.folder, vertex.id);
        if (map.extend)
            fs::copy_file(
                submapFile(map.folder, vertex.id), store_.fileOf(vertex.id),
                fs::copy_options::overwrite_existing);
        vertex.fixed = vertex.fixed || !map.extend;
        own_path_begin_ = std::max(own_path_begin_, submap.path_end + kBetweenRecordings);
        places_->add(submap);
        appearance_->add(submap);
    }
    if (!map.extend) known.relative_edges = {}, known.gravity_edges = {};
    addGraph(known, 0);
    store_.readAlsoFrom((fs::path(map.folder) / "submaps").string());
    first_own_ = graph_.vertices.size();
    first_own_id_ = known.vertices.back().id + 1;
    builder_.goOnFrom(first_own_id_, own_path_begin_);
}

/* Adds a graph whose ids grow by `shift`. */
void Mapper::addGraph(const PoseGraph& graph, VertexId shift)
{
    for (GraphVertex vertex : graph.vertices)
    {
        vertex.id += shift;
        graph_.vertices.push_back(vertex);
    }
    for (RelativeEdge edge : graph.relative_edges)
    {
        edge.from += shift;
        edge.to += shift;
        graph_.relative_edges.push_back(edge);
        weights_.push_back(1);
    }
    for (GravityEdge edge : graph.gravity_edges)
    {
        edge.vertex += shift;
        graph_.gravity_edges.push_back(edge);
    }
    covariance_.reset();
}

void Mapper::addRun(const std::string& folder)
{
    const Watch watch(seconds_);
    const PoseGraph run = readGraph(folder);
    const VertexId shift = first_own_id_;
    for (const GraphVertex& vertex : run.vertices)
    {
        Submap submap = readSubmapOf(folder, vertex.id);
        submap.id += shift;
        submap.path_begin += own_path_begin_;
        submap.path_end += own_path_begin_;
        places_->add(submap);
        appearance_->add(submap);
        store_.add(std::move(submap));
    }
    addGraph(run, shift);
    for (const GraphVertex& vertex : run.vertices)
    {
        searchFor(vertex.id + shift, *places_);
        searchFor(vertex.id + shift, *appearance_);
        weighPending();
    }
}

void Mapper::take(Submap submap)
{
    const Watch watch(seconds_);
    const VertexId id = submap.id;
    Pose T_world_submap = submap.T_world_submap;
    if (submaps() > 0)
    {
        const auto before = store_.at(graph_.vertices.back().id);
        graph_.relative_edges.push_back(odometryEdge(*before, submap));
        T_world_submap =
            graph_.vertices.back().T_world_submap * graph_.relative_edges.back().T_from_to;
        weights_.push_back(1);
    }
    graph_.vertices.push_back({id, T_world_submap, submaps() == 0 && !joined_});
    const Matrix3d tilt = submap.up_covariance.ldlt().solve(Matrix3d::Identity());
    graph_.gravity_edges.push_back({id, submap.up_submap, 0.5 * (tilt + tilt.transpose())});
    covariance_.reset();
    places_->add(submap);
    appearance_->add(submap);
    store_.add(std::move(submap));
    judgeStart(id);
    searchFor(id, *places_);
    searchFor(id, *appearance_);
    weighPending();
}

void Mapper::finish()
{
    builder_.finish();
    const Watch watch(seconds_);
    for (int round = 0; round < kRounds; round++)
    {
        const std::size_t judged = loops_.size(), accepted = accepted_;
        for (std::size_t i = first_own_; i < graph_.vertices.size(); i++)
            searchFor(graph_.vertices[i].id, *places_);
        weighPending();
        learnDrift();
        if (round > 0 && loops_.size() == judged && accepted_ == accepted) break;
    }
    weighGaps();
    if (isApart()) weighJoints(true);
    if (isApart() && warn_)
        warn_(
            {graph_.vertices.size() > first_own_
                 ? store_.at(graph_.vertices[first_own_].id)->scans.front().t
                 : 0,
             "place_unknown",
             "no place of the map in '" + known_->folder +
                 "' was recognised: the results are in a frame of their own"});
    for (LoopClosure& loop : loops_)
        if (loop.verdict == Verdict::Pending)
            loop.reason = isApart() && !isOwn(loop.from)
                              ? "too few places of the map agree, or others say as much"
                              : format(
                                    "the gap is unlikely (chi2 %.0f) and no second loop agrees",
                                    loop.evidence.chi2);
}

const Pose& Mapper::poseOf(VertexId id) const
{
    return poseIn(graph_, id);
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

void Mapper::searchFor(VertexId id, const PlaceRecognizer& recognizer)
{
    const PlaceKnowledge knowledge{
        [this](VertexId submap) { return poseOf(submap); },
        [this](VertexId from, VertexId to) { return covarianceOf(from, to); }};
    for (LoopCandidate candidate : recognizer.candidates(id, knowledge))
    {
        if (!isOwn(candidate.to)) continue;
        candidate.between_recordings = !isOwn(candidate.from);
        if (judged_.insert({candidate.from, candidate.to}).second) judge(candidate);
    }
}

void Mapper::judgeStart(VertexId id)
{
    if (!known_ || !known_->T_map_start || joined_ || id != first_own_id_) return;
    // The nearest place of the map to where the run is said to begin: position and heading.
    const Pose T_map_submap = *known_->T_map_start;
    const GraphVertex* nearest = nullptr;
    for (std::size_t i = 0; i < first_own_; i++)
    {
        const GraphVertex& v = graph_.vertices[i];
        const auto distance = [&](const GraphVertex& to)
        { return (to.T_world_submap.p - T_map_submap.p).norm(); };
        if (nearest == nullptr || distance(v) < distance(*nearest)) nearest = &v;
    }
    if (nearest == nullptr) return;
    LoopCandidate candidate;
    candidate.from = nearest->id;
    candidate.to = id;
    candidate.T_from_to = nearest->T_world_submap.inverse() * T_map_submap;
    candidate.covariance.diagonal() << 1, 1, 0.25, 0.03, 0.03, 0.03;
    candidate.source = "start";
    candidate.between_recordings = true;
    judged_.insert({candidate.from, candidate.to});
    judge(candidate);
}

void Mapper::judge(const LoopCandidate& candidate)
{
    loops_.push_back(judge_.judge(candidate, viewOf(candidate.from), viewOf(candidate.to)));
}

bool Mapper::agrees(const LoopClosure& a, const LoopClosure& b)
{
    // Round the circle that both loops make with the path beside them.
    if (a.from == b.from && a.to == b.to) return false;
    const std::optional<Matrix6d> of_from = covarianceOf(a.from, b.from);
    const std::optional<Matrix6d> of_to = covarianceOf(a.to, b.to);
    if (!of_from || !of_to) return false;
    const Pose beside_to = between(a.to, b.to), beside_from = between(a.from, b.from);
    const Pose there = a.T_from_to * beside_to;
    const Pose back = beside_from * b.T_from_to;
    const auto carried = [](const Matrix6d& covariance, const Pose& by)
    {
        const Matrix6d J = rightFromLeft(by);
        return Matrix6d(J * covariance * J.transpose());
    };
    const Matrix6d covariance = carried(covarianceOfLoop(a), beside_to) + *of_to +
                                carried(*of_from, b.T_from_to) + covarianceOfLoop(b);
    const Vector6d gap = rightErrorTo(there, back);
    const double chi2 = gap.dot(covariance.ldlt().solve(gap));
    return chi2 < chiSquareBeyond(kBeyond, std::min(a.evidence.directions, b.evidence.directions));
}

void Mapper::weighPending()
{
    if (isApart()) weighJoints(false);
    bool changed = true;
    while (changed)
    {
        changed = false;
        for (LoopClosure& loop : loops_)
        {
            if (loop.verdict != Verdict::Pending) continue;
            if (isApart() && !isOwn(loop.from)) continue;
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

std::vector<Mapper::Joints> Mapper::agreeingJoints() const
{
    std::vector<Joints> groups;
    for (std::size_t i = 0; i < loops_.size(); i++)
    {
        const LoopClosure& loop = loops_[i];
        if (loop.verdict != Verdict::Pending || isOwn(loop.from)) continue;
        const Pose T = poseOf(loop.from) * loop.T_from_to * poseOf(loop.to).inverse();
        const auto says_the_same = [&](const Joints& g)
        {
            // Where the submap stands by the one and by the other.
            const Pose a = g.T_map_run * poseOf(loop.to), b = T * poseOf(loop.to);
            return (a.p - b.p).norm() < kJointApart &&
                   logSO3(a.R.transpose() * b.R).norm() < kJointTurned;
        };
        auto group = std::find_if(groups.begin(), groups.end(), says_the_same);
        if (group == groups.end()) group = groups.insert(groups.end(), {T, {}, 0});
        group->loops.push_back(i);
        group->evidence += std::exp(-loop.evidence.conflicts / kTellingConflicts);
    }
    std::stable_sort(
        groups.begin(), groups.end(),
        [](const Joints& a, const Joints& b) { return a.evidence > b.evidence; });
    return groups;
}

void Mapper::weighJoints(bool at_the_end)
{
    const std::vector<Joints> groups = agreeingJoints();
    if (groups.empty()) return;
    const double second = groups.size() > 1 ? groups[1].evidence : 0;
    std::set<VertexId> submaps;
    for (const std::size_t i : groups[0].loops) submaps.insert(loops_[i].to);
    const bool clearly_best = groups[0].evidence >= kClearly * second;
    // While the run goes on there is time to hear a second submap.
    if (clearly_best && (submaps.size() >= 2 || at_the_end)) join(groups[0]);
}

void Mapper::join(const Joints& joints)
{
    const PoseGraph apart = graph_;
    const std::size_t accepted = accepted_;
    for (std::size_t i = first_own_; i < graph_.vertices.size(); i++)
    {
        GraphVertex& vertex = graph_.vertices[i];
        vertex.T_world_submap = joints.T_map_run * vertex.T_world_submap;
        vertex.fixed = false;
    }
    covariance_.reset();
    for (const std::size_t i : joints.loops)
        accept(loops_[i], format("%zu places of the map agree", joints.loops.size()));
    joined_ = accepted_ > accepted;
    if (!joined_) graph_ = apart;
}

PoseGraph Mapper::resultGraph() const
{
    if (!known_ || known_->extend) return graph_;
    PoseGraph own;
    own.vertices.assign(
        graph_.vertices.begin() + static_cast<std::ptrdiff_t>(first_own_), graph_.vertices.end());
    for (const RelativeEdge& edge : graph_.relative_edges)
        if (isOwn(edge.from) && isOwn(edge.to)) own.relative_edges.push_back(edge);
    own.gravity_edges = graph_.gravity_edges;
    return own;
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

/* Whether the submap at a position of the graph goes on where the one before it ended. */
bool Mapper::followsTheLast(std::size_t position) const
{
    const auto before = store_.at(graph_.vertices[position - 1].id);
    return before->path_end == store_.at(graph_.vertices[position].id)->path_begin;
}

PoseGraph Mapper::odometryAlone() const
{
    PoseGraph alone = graph_;
    for (RelativeEdge& edge : alone.relative_edges) edge.enabled = edge.kind == EdgeKind::Odometry;
    for (std::size_t i = first_own_ + 1; i < alone.vertices.size(); i++)
    {
        const VertexId before = alone.vertices[i - 1].id, now = alone.vertices[i].id;
        const Pose step = followsTheLast(i) ? nextInFrameOf(*store_.at(before), *store_.at(now))
                                            : between(before, now);
        alone.vertices[i].T_world_submap = alone.vertices[i - 1].T_world_submap * step;
    }
    return alone;
}

std::vector<ClosedGap> Mapper::gapsOf(const PoseGraph& odometry) const
{
    std::vector<ClosedGap> gaps;
    std::shared_ptr<const GraphCovariance> covariance;
    for (const LoopClosure& loop : loops_)
    {
        if (loop.verdict != Verdict::Accepted || !isOwn(loop.from)) continue;
        if (!covariance) covariance = optimizer_->covariance(odometry, {});
        gaps.push_back(
            {rightErrorTo(
                 poseIn(odometry, loop.from).inverse() * poseIn(odometry, loop.to), loop.T_from_to),
             covariance->relative(loop.from, loop.to) / drift_scale_, loop.information});
    }
    return gaps;
}

void Mapper::learnDrift()
{
    const std::vector<ClosedGap> gaps = gapsOf(odometryAlone());
    if (gaps.empty()) return;
    const double scale = driftScale(gaps);
    for (RelativeEdge& edge : graph_.relative_edges)
        if (edge.kind == EdgeKind::Odometry && isOwn(edge.from))
            edge.information *= drift_scale_ / scale;
    drift_scale_ = scale;
    weights_ = optimizer_->optimize(graph_).weights;
    covariance_.reset();
}

void Mapper::weighGaps()
{
    const PoseGraph odometry = odometryAlone();
    double chi2 = 0;
    int directions = 0;
    for (const ClosedGap& gap : gapsOf(odometry))
    {
        const GapTest test = testGap(gap.gap, Matrix6d::Zero(), gap.information);
        chi2 += test.chi2;
        directions += test.directions;
    }
    gaps_count_ = directions > 0 && chi2 > chiSquareBeyond(kGapsByChance, directions);
    if (moved()) return;
    for (std::size_t i = 0; i < graph_.vertices.size(); i++)
        graph_.vertices[i].T_world_submap = odometry.vertices[i].T_world_submap;
    for (LoopClosure& loop : loops_)
        if (loop.verdict == Verdict::Accepted)
            loop.reason = "the odometry is already as near as the loop can tell: nothing moves";
}

std::vector<Mapper::Run> Mapper::runs() const
{
    if (!known_ || !known_->extend) return {ownRun()};
    std::vector<Run> runs;
    for (std::size_t i = 0; i < graph_.vertices.size(); i++)
    {
        if (i == 0 || !followsTheLast(i)) runs.push_back({i, i});
        runs.back().end = i + 1;
    }
    return runs;
}

void Mapper::forPath(const Run& run, const std::function<void(Time, const Pose&)>& visit) const
{
    for (std::size_t i = run.begin; i < run.end; i++)
    {
        const GraphVertex& vertex = graph_.vertices[i];
        const auto submap = store_.at(vertex.id);
        std::vector<Pose> poses;
        if (i + 1 < run.end)
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
        for (std::size_t k = i == run.begin ? 0 : 1; k < poses.size(); k++)
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
    for (const GraphVertex& vertex : resultGraph().vertices)
    {
        const std::string name = fs::path(store_.fileOf(vertex.id)).stem().string();
        PlyPointWriter file(folder_ + "/" + name + ".ply");
        for (const SubmapPoint& p : store_.at(vertex.id)->points)
        {
            const Vector3d in_world = vertex.T_world_submap * Vector3d(p.position.cast<double>());
            file.append({in_world.cast<float>(), 0});
        }
        file.close();
    }
}
}  // namespace taut
