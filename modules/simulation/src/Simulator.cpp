#include "taut/simulation/Simulator.h"

#include <sstream>
#include <stdexcept>

namespace taut::simulation
{
Simulator::Stage Simulator::makeStage(
    const Scenario& scenario, const std::vector<RecordedPose>& recording)
{
    const auto seed = static_cast<std::uint64_t>(scenario.seed);
    const MotionConfig& motion = scenario.motion;
    World world = makeWorld(scenario.world);
    const Wind& wind = scenario.world.wind;
    std::vector<Foliage> foliage;
    if (wind.sway > 0) foliage = takeLeaves(world.mesh, wind, seed);
    Texture texture = scenario.world.texture;
    texture.seed = static_cast<std::uint64_t>(scenario.world.seed);
    Scene scene{RayCaster(std::move(world.mesh)), {}, std::move(foliage), texture};
    if (motion.type == MotionPreset::Replay)
        return {
            std::move(scene),
            makeReplay(
                recording, motion.replay, motion.knot_spacing, scenario.duration, scenario.rest)};
    const Course course = makeCourse(motion, world.route, scenario.duration, scenario.rest);
    scene.movers = makeTraffic(world.traffic, course, scenario.world.moving, seed);
    for (Mover& companion : makeCompanions(scenario.world.companions, course, seed))
        scene.movers.push_back(std::move(companion));
    return {std::move(scene), makeMotion(motion, course, seed)};
}

Simulator::Simulator(const Scenario& scenario, const std::vector<RecordedPose>& recording)
    : Simulator(scenario, makeStage(scenario, recording))
{
}

Simulator::Simulator(const Scenario& scenario, Stage stage)
    : scenario_(scenario),
      scene_(std::move(stage.scene)),
      motion_(std::move(stage.motion)),
      imu_(simulateImu(
          scenario.imu, motion_, scenario.duration, static_cast<std::uint64_t>(scenario.seed))),
      lidar_(scenario.lidar, static_cast<std::uint64_t>(scenario.seed), scenario.weather)
{
    checkClearance();
}

void Simulator::checkClearance() const
{
    constexpr double step = 0.02;
    for (double t = 0; t <= scenario_.duration; t += step)
    {
        const Vector3d p = motion_.poseAt(t).p;
        const double clearance = scene_.world.clearance(p, scenario_.clearance);
        if (clearance >= scenario_.clearance) continue;
        std::ostringstream s;
        s << "the motion comes within " << clearance << " m of a surface at t = " << t << " s, at ("
          << p.transpose() << ")";
        throw std::runtime_error(s.str());
    }
}

SimulatedScan Simulator::sweep(int k, Executor& executor) const
{
    return lidar_.sweep(k, motion_, scene_, executor);
}
}  // namespace taut::simulation
