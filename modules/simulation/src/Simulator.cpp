#include "taut/simulation/Simulator.h"

#include <sstream>
#include <stdexcept>

namespace taut::simulation
{
namespace
{
constexpr double kClearance = 0.25;  // of the body from every surface [m]
}

Simulator::Simulator(const Scenario& scenario) : Simulator(scenario, makeWorld(scenario.world)) {}

Simulator::Simulator(const Scenario& scenario, World world)
    : scenario_(scenario),
      caster_(std::move(world.mesh)),
      motion_(makeMotion(
          scenario.motion, world.route, scenario.duration, scenario.rest,
          static_cast<std::uint64_t>(scenario.seed))),
      imu_(simulateImu(
          scenario.imu, motion_, scenario.duration, static_cast<std::uint64_t>(scenario.seed))),
      lidar_(scenario.lidar, static_cast<std::uint64_t>(scenario.seed))
{
    checkClearance();
}

void Simulator::checkClearance() const
{
    constexpr double step = 0.02;
    for (double t = 0; t <= scenario_.duration; t += step)
    {
        const Vector3d p = motion_.poseAt(t).p;
        const double clearance = caster_.clearance(p, kClearance);
        if (clearance >= kClearance) continue;
        std::ostringstream s;
        s << "the motion comes within " << clearance << " m of a surface at t = " << t << " s, at ("
          << p.transpose() << ")";
        throw std::runtime_error(s.str());
    }
}

SimulatedScan Simulator::sweep(int k, Executor& executor) const
{
    return lidar_.sweep(k, motion_, caster_, executor);
}
}  // namespace taut::simulation
