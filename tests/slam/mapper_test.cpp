#include "taut/slam/Mapper.h"

#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/poses/CPose3D.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "taut/files/PlyFile.h"
#include "taut/graph/G2oFile.h"
#include "taut/graph/SparseGraphOptimizer.h"
#include "taut/places/NearbyPlaces.h"
#include "taut/places/PlacesByView.h"
#include "taut/slam/LoopScores.h"
#include "taut/slam/LoopsFile.h"
#include "taut/slam/SimpleMapFile.h"
#include "temporary_folder.h"
#include "walks.h"

using namespace taut;
using namespace taut::test;

namespace
{
class AMapper : public ::testing::Test
{
 protected:
    AMapper()
    {
        config.places = Prototype<PlaceRecognizer>(std::make_shared<NearbyPlaces>());
        config.appearance = Prototype<PlaceRecognizer>(std::make_shared<PlacesByView>());
        config.optimizer = Prototype<GraphOptimizer>(std::make_shared<SparseGraphOptimizer>());
    }

    /** Round the ring; fills `truth` and `odometry_path`. */
    std::unique_ptr<Mapper> walk(
        double length, double scale, double turn, int threads = 1,
        const std::function<Pose(double)>& way = aroundRing, const Scene& scene = ring())
    {
        truth.clear();
        odometry_path.clear();
        executor = std::make_unique<Executor>(threads);
        auto mapper = std::make_unique<Mapper>(
            config, folder / ("submaps" + std::to_string(runs++)), *executor,
            [this](const Warning& w) { warnings.push_back(w); });
        DriftingOdometry odometry;
        odometry.scale = scale;
        odometry.turn = turn;
        odometry.start(way(0));
        Random random(1);
        const Time begin = 1'700'000'000'000'000'000;
        truth[begin] = odometry_path[begin] = odometry.estimate;
        mapper->start(estimateAt(begin, odometry.estimate));
        carry(
            scene, way, length, odometry, random,
            [&](const NavEstimate& e, const std::vector<Vector3d>& points)
            {
                truth[e.state.t] = odometry.truth;
                odometry_path[e.state.t] = odometry.estimate;
                mapper->add(e, points, {});
            });
        mapper->finish();
        return mapper;
    }

    double errorOf(const std::map<Time, Pose>& path) const
    {
        double sum = 0;
        for (const auto& [t, pose] : path) sum += (pose.p - truth.at(t).p).squaredNorm();
        return std::sqrt(sum / static_cast<double>(path.size()));
    }

    static std::map<Time, Pose> pathOf(const Mapper& mapper)
    {
        std::map<Time, Pose> path;
        mapper.forPath(mapper.ownRun(), [&](Time t, const Pose& pose) { path[t] = pose; });
        return path;
    }

    TemporaryFolder folder;
    SlamConfig config = slamConfig();
    std::unique_ptr<Executor> executor;
    std::map<Time, Pose> truth, odometry_path;
    std::vector<Warning> warnings;
    int runs = 0;
};
}  // namespace

TEST_F(AMapper, TakesTheDriftOutOfASecondLap)
{
    const auto mapper = walk(220, 1.003, 1.5e-4);
    const double before = errorOf(odometry_path), after = errorOf(pathOf(*mapper));
    RecordProperty("before_mm", std::to_string(1e3 * before));
    RecordProperty("after_mm", std::to_string(1e3 * after));
    EXPECT_GE(mapper->accepted(), 4u);
    EXPECT_GT(before, 0.3);
    EXPECT_LT(after, 0.3 * before);
    for (const LoopClosure& loop : mapper->loops())
    {
        if (loop.verdict != Verdict::Accepted) continue;
        const auto at = [&](VertexId id)
        {
            const auto submap = mapper->submap(id);
            return truth.at(submap->scans[0].t) * submap->scans[0].T_submap_imu.inverse();
        };
        const Pose gap = (at(loop.from).inverse() * at(loop.to)).inverse() * loop.T_from_to;
        EXPECT_LT(gap.p.norm(), 0.08) << loop.from << " to " << loop.to;
    }
}

TEST_F(AMapper, LeavesAPathWithoutLoopsAsItIs)
{
    const auto mapper = walk(80, 1.003, 1.5e-4);
    EXPECT_FALSE(mapper->moved());
    const auto path = pathOf(*mapper);
    ASSERT_EQ(path.size(), odometry_path.size());
    for (const auto& [t, pose] : path) EXPECT_LT((pose.p - odometry_path.at(t).p).norm(), 1e-9);
}

TEST_F(AMapper, LeavesAPathWithoutDriftAsItIsThoughItSeesLoops)
{
    const auto mapper = walk(220, 1, 0);
    EXPECT_GE(mapper->accepted(), 4u);
    EXPECT_FALSE(mapper->moved());
    for (const auto& [t, pose] : pathOf(*mapper))
        EXPECT_LT((pose.p - odometry_path.at(t).p).norm(), 1e-9);
}

TEST_F(AMapper, HasItsLoopsScored)
{
    const auto mapper = walk(220, 1.003, 1.5e-4);
    std::filesystem::create_directories(folder / "run");
    std::filesystem::rename(folder / "submaps0", folder / "run/submaps");
    writeG2o(folder / "run/graph.g2o", mapper->resultGraph());
    const auto at = [&](Time t)
    {
        const auto found = truth.find(t);
        return found == truth.end() ? std::optional<Pose>() : found->second;
    };
    const LoopScores right = scoreLoops(folder / "run", at);
    EXPECT_EQ(right.loops, static_cast<int>(mapper->accepted()));
    EXPECT_EQ(right.wrong, 0);
    EXPECT_GE(right.revisits, 5);
    EXPECT_GE(right.recall(), 0.8);
    // A loop that is a metre off is found out.
    PoseGraph graph = mapper->resultGraph();
    for (RelativeEdge& edge : graph.relative_edges)
        if (edge.kind == EdgeKind::LoopClosure) edge.T_from_to.p.y() += 1;
    writeG2o(folder / "run/graph.g2o", graph);
    const LoopScores wrong = scoreLoops(folder / "run", at);
    EXPECT_EQ(wrong.wrong, wrong.loops);
    EXPECT_EQ(wrong.recognised, 0);
}

TEST_F(AMapper, GivesTheSameBitsWithTwoThreads)
{
    const auto one = walk(150, 1.003, 1.5e-4, 1), two = walk(150, 1.003, 1.5e-4, 2);
    ASSERT_TRUE(one->moved());
    const auto a = pathOf(*one), b = pathOf(*two);
    for (const auto& [t, pose] : a) EXPECT_TRUE(pose.p == b.at(t).p && pose.R == b.at(t).R);
}

TEST_F(AMapper, NeverMergesStoreysThatLookAlike)
{
    // Round the ring, up 3.2 m by a ramp that nobody sees, and round the ring again.
    const auto way = [](double s)
    {
        Pose pose = aroundRing(s);
        pose.p.z() += std::clamp((s - 115) / 5, 0.0, 1.0) * 3.2;
        return pose;
    };
    truth.clear();
    executor = std::make_unique<Executor>(1);
    Mapper mapper(config, folder / "storeys", *executor, {});
    DriftingOdometry odometry;
    odometry.start(way(0));
    Random random(1);
    mapper.start(estimateAt(1'700'000'000'000'000'000, odometry.estimate));
    Time t = 1'700'000'000'000'000'000;
    for (double s = 0.5; s <= 230; s += 0.5)
    {
        odometry.moveTo(way(s));
        // Each storey is the same ring: seen from the body's height above its floor.
        Pose within = odometry.truth;
        within.p.z() = 1.2;
        std::vector<Vector3d> points = pointsSeenFrom(ring(), within, random);
        for (Vector3d& p : points) p = odometry.estimate * p;
        mapper.add(estimateAt(t += 500'000'000, odometry.estimate), points, {});
    }
    mapper.finish();
    for (const LoopClosure& loop : mapper.loops())
    {
        if (loop.verdict != Verdict::Accepted) continue;
        const auto height = [&](VertexId id) { return mapper.submap(id)->T_world_submap.p.z(); };
        EXPECT_LT(std::abs(height(loop.from) - height(loop.to)), 0.5)
            << loop.from << " to " << loop.to;
    }
}

TEST_F(AMapper, LeavesFilesThatOthersOpen)
{
    const auto mapper = walk(150, 1.003, 1.5e-4);
    const std::size_t submaps = mapper->graph().vertices.size();
    mapper->writeClouds();
    std::size_t points = 0;
    for (std::size_t i = 0; i < submaps; i++)
        points += readPlyPoints(
                      folder / ("submaps0/" + std::string(i < 10 ? "0000" : "000") +
                                std::to_string(i) + ".ply"))
                      .size();
    EXPECT_GT(points, 1000 * submaps);

    writeSimpleMap(folder / "map.simplemap", *mapper);
    mrpt::maps::CSimpleMap map;
    ASSERT_TRUE(map.loadFromFile(folder / "map.simplemap"));
    ASSERT_EQ(map.size(), submaps);
    const auto [pose, frame] = map.get(3);
    mrpt::poses::CPose3D mean;
    pose->getMean(mean);
    const Vector3d& p = mapper->graph().vertices[3].T_world_submap.p;
    EXPECT_NEAR(mean.x(), p.x(), 1e-6);
    EXPECT_NEAR(mean.y(), p.y(), 1e-6);
    const auto cloud = frame->getObservationByClass<mrpt::obs::CObservationPointCloud>();
    ASSERT_TRUE(cloud);
    EXPECT_GT(cloud->pointcloud->size(), 1000u);

    writeLoops(folder / "loops.csv", mapper->loops());
    std::ifstream table(folder / "loops.csv");
    std::string line;
    std::getline(table, line);
    const auto commas = std::count(line.begin(), line.end(), ',');
    std::size_t rows = 0;
    for (; std::getline(table, line); rows++)
        EXPECT_GE(std::count(line.begin(), line.end(), ','), commas) << line;
    EXPECT_EQ(rows, mapper->loops().size());
    EXPECT_EQ(mapper->joinedPlaces().size(), mapper->accepted());
}

namespace
{
/** A run that leaves its map in a folder, as a session does, and another one that uses it. */
class AKnownMap : public AMapper
{
 protected:
    /** Leaves graph and submaps of a lap in `folder`/first. */
    void mapTheRing()
    {
        std::filesystem::create_directories(folder / "first");
        executor = std::make_unique<Executor>(1);
        Mapper mapper(config, folder / "first/submaps", *executor, {});
        go(mapper, 0, 125, ring(), 1);
        writeG2o(folder / "first/graph.g2o", mapper.resultGraph());
    }

    /** Carries the LiDAR from a place of the ring on; the odometry begins at a frame of its own. */
    void go(Mapper& mapper, double from, double length, const Scene& scene, unsigned seed)
    {
        truth.clear();
        DriftingOdometry odometry;
        const auto way = [&](double s) { return aroundRing(from + s); };
        odometry.start(way(0));
        odometry.estimate = kStart;
        if (from == 0) odometry.estimate = odometry.truth;
        Random random(seed);
        const Time begin = 1'700'000'000'000'000'000;
        truth[begin] = odometry.truth;
        mapper.start(estimateAt(begin, odometry.estimate));
        carry(
            scene, way, length, odometry, random,
            [&](const NavEstimate& e, const std::vector<Vector3d>& points)
            {
                truth[e.state.t] = odometry.truth;
                mapper.add(e, points, {});
            });
        mapper.finish();
    }

    std::unique_ptr<Mapper> second(
        const KnownMap& map, double from, double length, const Scene& scene)
    {
        auto mapper = std::make_unique<Mapper>(
            config, folder / ("second" + std::to_string(runs++) + "/submaps"), *executor,
            [this](const Warning& w) { warnings.push_back(w); });
        mapper->use(map);
        go(*mapper, from, length, scene, 5);
        return mapper;
    }

    const Pose kStart{expSO3({0, 0, 0.9}), {3, -8, 0.4}};
};
}  // namespace

TEST_F(AKnownMap, IsRecognisedWithoutAGuessAndStaysAsItIs)
{
    mapTheRing();
    const PoseGraph before = readG2o(folder / "first/graph.g2o");
    for (const double from : {17.0, 88.0})
    {
        const auto mapper = second({folder / "first", false, {}}, from, 30, ring());
        EXPECT_FALSE(mapper->isApart()) << from;
        EXPECT_LT(errorOf(pathOf(*mapper)), 0.02) << from;
        for (std::size_t i = 0; i < before.vertices.size(); i++)
            EXPECT_EQ(
                mapper->graph().vertices[i].T_world_submap.p, before.vertices[i].T_world_submap.p);
        EXPECT_EQ(mapper->resultGraph().vertices.size(), mapper->submaps());
    }
}

TEST_F(AKnownMap, WithThingsMovedIsRecognised)
{
    mapTheRing();
    Scene moved = ring();
    for (std::size_t i = 1; i < moved.obstacles.size(); i += 3)
    {
        moved.obstacles[i].min.x() += 0.8;
        moved.obstacles[i].max.x() += 0.8;
    }
    const auto mapper = second({folder / "first", false, {}}, 17, 40, moved);
    EXPECT_FALSE(mapper->isApart());
    EXPECT_LT(errorOf(pathOf(*mapper)), 0.05);
}

TEST_F(AKnownMap, IsJoinedWithARunThatWasMadeForItself)
{
    mapTheRing();
    std::filesystem::create_directories(folder / "alone");
    Mapper alone(config, folder / "alone/submaps", *executor, {});
    go(alone, 17, 60, ring(), 5);
    writeG2o(folder / "alone/graph.g2o", alone.resultGraph());

    Mapper both(config, folder / "both/submaps", *executor, {});
    both.use({folder / "first", true, {}});
    both.addRun(folder / "alone");
    both.finish();
    EXPECT_FALSE(both.isApart());
    const std::vector<Mapper::Run> parts = both.runs();
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[1].end - parts[1].begin, alone.submaps());
    EXPECT_EQ(both.resultGraph().vertices.size(), parts[1].end);
    std::map<Time, Pose> path;
    both.forPath(parts[1], [&](Time t, const Pose& pose) { path[t] = pose; });
    EXPECT_EQ(path.size(), truth.size());
    EXPECT_LT(errorOf(path), 0.02);  // in the frame of the first run
}

TEST_F(AKnownMap, OfAnotherPlaceIsNotRecognised)
{
    mapTheRing();
    Scene other;
    other.room = {{-23, -17, 0}, {23, 17, 4}};
    other.obstacles = {
        {{-14, -9, 0}, {-2, 9, 4}}, {{4, -8, 0}, {14, -2, 4}}, {{5, 3, 0}, {13, 9, 4}}};
    const auto mapper = second({folder / "first", false, {}}, 17, 40, other);
    EXPECT_TRUE(mapper->isApart());
    EXPECT_FALSE(mapper->moved());
    ASSERT_FALSE(warnings.empty());
    EXPECT_EQ(warnings.back().kind, "place_unknown");
}

TEST_F(AKnownMap, IsFoundFromAStartThatIsTold)
{
    mapTheRing();
    // Where the first pose is in the map, told a little wrong.
    const Pose T_map_start = aroundRing(17) * Pose{expSO3({0, 0, 0.1}), {0.4, -0.3, 0}};
    const auto mapper = second({folder / "first", false, T_map_start}, 17, 12, ring());
    EXPECT_FALSE(mapper->isApart());
    EXPECT_LT(errorOf(pathOf(*mapper)), 0.02);
}

TEST_F(AKnownMap, IsExtendedByARunThatGoesOn)
{
    mapTheRing();
    const auto mapper = second({folder / "first", true, {}}, 60, 30, ring());
    ASSERT_FALSE(mapper->isApart());
    const PoseGraph all = mapper->resultGraph();
    EXPECT_EQ(
        all.vertices.size(),
        readG2o(folder / "first/graph.g2o").vertices.size() + mapper->submaps());
    for (const GraphVertex& v : all.vertices) EXPECT_NO_THROW(mapper->submap(v.id));
    const std::string folder_of_both = folder / ("second" + std::to_string(runs - 1));
    writeG2o(folder_of_both + "/graph.g2o", all);
    // The result is a map like any other.
    const auto third = second({folder_of_both, false, {}}, 80, 25, ring());
    EXPECT_FALSE(third->isApart());
}

TEST_F(AKnownMap, ThatIsDamagedIsRefused)
{
    mapTheRing();
    const auto fault = [&](const std::string& map) -> std::string
    {
        try
        {
            Mapper mapper(config, folder / "refused/submaps", *executor, {});
            mapper.use({map, false, {}});
        }
        catch (const std::runtime_error& e)
        {
            return e.what();
        }
        return "";
    };
    EXPECT_NE(fault(folder / "nowhere").find("graph.g2o"), std::string::npos);
    std::filesystem::resize_file(folder / "first/submaps/00002.tsm", 1000);
    EXPECT_NE(fault(folder / "first").find("00002.tsm"), std::string::npos);
    std::ofstream(folder / "first/graph.g2o") << "";
    EXPECT_NE(fault(folder / "first").find("no submaps"), std::string::npos);
}
