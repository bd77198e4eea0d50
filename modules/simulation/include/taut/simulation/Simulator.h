#pragma once

#include "taut/core/Parallel.h"
#include "taut/simulation/Scenario.h"

namespace taut::simulation
{
/** A scenario come true: motion, IMU and LiDAR in one world. All times count from its start. */
class Simulator
{
 public:
    /** Throws std::runtime_error if the motion comes too close to a surface, with the time and the
     * place. */
    explicit Simulator(const Scenario& scenario);

    const Motion& motion() const { return motion_; }
    const RayCaster& world() const { return caster_; }
    const ImuRecording& imu() const { return imu_; }
    int sweeps() const { return lidar_.sweeps(scenario_.duration); }
    SimulatedScan sweep(int k, Executor& executor) const;

 private:
    Simulator(const Scenario& scenario, World world);
    void checkClearance() const;

    Scenario scenario_;
    RayCaster caster_;
    Motion motion_;
    ImuRecording imu_;
    Lidar lidar_;
};
}  // namespace taut::simulation
