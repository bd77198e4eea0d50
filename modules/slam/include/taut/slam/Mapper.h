#pragma once

#include <functional>
#include <list>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "taut/core/LoopClosure.h"
#include "taut/core/Parallel.h"
#include "taut/core/Warning.h"
#include "taut/slam/DriftScale.h"
#include "taut/slam/SlamConfig.h"
#include "taut/submaps/SubmapStore.h"

namespace taut
{
/** The map of an earlier run that a run is joined to. */
struct KnownMap
{
    std::string folder;   //!< of that run's results
    bool extend = false;  //!< its submaps may move and belong to the result; else they stay
    std::optional<Pose> T_map_start;  //!< of the first state: position and heading, to a
                                      //!< metre and ten degrees
};

/** From the odometry's path to one consistent map: cuts it into submaps, finds loops, judges them,
 * and keeps the pose graph. Not thread-safe. */
class Mapper
{
 public:
    /** Submaps are written to `folder`. Warnings: `loop_withdrawn`. */
    Mapper(const SlamConfig& config, std::string folder, Executor& executor, WarningSink warn);

    /** Before the path begins: joins the run to a known map as soon as a place of it is recognised.
     * The graph is told in the frame of that map from then on. Throws std::runtime_error that names
     * what cannot be used. */
    void use(const KnownMap& map);

    /** Takes the submaps and the graph of an earlier run as this run's, instead of a path that is
     * told state by state: looks for the loops that join them to the known map. `folder`: of its
     * results. Then finish(). Throws std::runtime_error that names what cannot be used. */
    void addRun(const std::string& folder);

    /** True if a known map was given and no place of it was recognised. */
    bool isApart() const { return known_ && !joined_; }

    /** The path begins at this state. */
    void start(const NavEstimate& first) { builder_.start(first); }

    /** As SubmapBuilder::add(). Now and then a submap ends: then loops are looked for. */
    void add(
        const NavEstimate& estimate, const std::vector<Vector3d>& points_world,
        const Pose& T_imu_lidar)
    {
        builder_.add(estimate, points_world, T_imu_lidar);
    }

    /** From here on the pose is in doubt, or no more. */
    void setDoubt(bool doubtful) { builder_.setDoubt(doubtful); }

    /** The path is complete: ends the last submap, and looks for loops in all of the graph until
     * nothing new is found. */
    void finish();

    /** After finish(): true if the path is not the odometry's any more. It stays so where all loops
     * that are believed say no more than that they cannot tell it from theirs: a body that never
     * left its map has no gaps, and the odometry measures better than two submaps do. */
    bool moved() const { return joined_ || gaps_count_; }

    const PoseGraph& graph() const { return graph_; }
    /** The part of the graph that belongs to the results: without a known map that only serves. */
    PoseGraph resultGraph() const;
    /** Submaps of this run. */
    std::size_t submaps() const { return graph_.vertices.size() - first_own_; }
    /** Everything that was judged, in that order. */
    const std::vector<LoopClosure>& loops() const { return loops_; }
    std::size_t accepted() const { return accepted_; }
    /** Factor on the covariance that the odometry claims of its drift, as the loops tell it. */
    double scaleOfDrift() const { return drift_scale_; }
    double seconds() const { return seconds_; }  //!< spent on loops and graph

    /** Submaps that follow one another on the path of one recording: positions in graph(). */
    struct Run
    {
        std::size_t begin = 0, end = 0;
    };
    /** This run. */
    Run ownRun() const { return {first_own_, graph_.vertices.size()}; }
    /** All runs that resultGraph() holds, the known map's first. */
    std::vector<Run> runs() const;

    /** Calls `visit(t, T_world_imu)` for every state of the corrected path of a run, in the order
     * of time. The first of all is the state that the path began with. Reads the submaps again. */
    void forPath(const Run& run, const std::function<void(Time, const Pose&)>& visit) const;

    /** Of each loop that is believed: where the body was at the begin of both submaps, world [m].
     */
    std::vector<std::pair<Vector3d, Vector3d>> joinedPlaces() const;

    /** The points of each submap as a PLY file beside the submap's own, where the graph has them in
     * the world. Throws std::runtime_error if one cannot be written. */
    void writeClouds() const;

    /** Submap `id` from the disk or from memory. */
    std::shared_ptr<const Submap> submap(VertexId id) const { return store_.at(id); }

    /** The same with a map of its points, in its frame. */
    SubmapView viewOf(VertexId id);

 private:
    void take(Submap submap);
    void searchFor(VertexId id, const PlaceRecognizer& recognizer);
    void judge(const LoopCandidate& candidate);
    void weighPending();
    std::vector<ClosedGap> gapsOf(const PoseGraph& odometry) const;
    void learnDrift();
    void weighGaps();
    void weighJoints(bool at_the_end);
    /** Loops into the known map that say the same of where the run is in it. */
    struct Joints
    {
        Pose T_map_run;                  //!< by the first of them
        std::vector<std::size_t> loops;  //!< positions in loops_
        double evidence = 0;             //!< each counts 1, less for what it sees through
    };
    std::vector<Joints> agreeingJoints() const;
    void join(const Joints& joints);
    void judgeStart(VertexId id);
    bool isOwn(VertexId id) const { return id >= first_own_id_; }
    void addGraph(const PoseGraph& graph, VertexId shift);
    bool followsTheLast(std::size_t position) const;
    PoseGraph odometryAlone() const;
    bool agrees(const LoopClosure& a, const LoopClosure& b);
    void accept(LoopClosure& loop, const std::string& reason);
    std::optional<Matrix6d> covarianceOf(VertexId from, VertexId to);
    Pose between(VertexId from, VertexId to) const;
    const Pose& poseOf(VertexId id) const;

    SlamConfig config_;
    Executor& executor_;
    WarningSink warn_;
    SubmapStore store_;
    std::string folder_;
    std::optional<KnownMap> known_;
    bool joined_ = false;
    std::size_t first_own_ = 0;  // position of this run's first vertex
    VertexId first_own_id_ = 0;
    double own_path_begin_ = 0;  // [m] on the way through all recordings
    std::unique_ptr<PlaceRecognizer> places_, appearance_;
    std::unique_ptr<GraphOptimizer> optimizer_;
    LoopJudge judge_;
    SubmapBuilder builder_;
    PoseGraph graph_;
    std::vector<double> weights_;                        // of the last solution
    std::shared_ptr<const GraphCovariance> covariance_;  // of the present graph; null: not known
    std::vector<LoopClosure> loops_;
    std::set<std::pair<VertexId, VertexId>> judged_;
    std::list<std::pair<VertexId, std::shared_ptr<const Map>>> maps_;  // the last used one first
    std::size_t accepted_ = 0;
    bool gaps_count_ = false;  // together they are more than the loops can err
    double drift_scale_ = 1;
    double seconds_ = 0;
};
}  // namespace taut
