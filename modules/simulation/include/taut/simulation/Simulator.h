#pragma once

#include "taut/core/Parallel.h"
#include "taut/simulation/Scenario.h"
#include "taut/simulation/Scene.h"

namespace taut::simulation
{
/** A scenario come true: motion, IMU and LiDAR in one world, without the faults of the recording.
 * All times count from its start. */
class Simulator
{
 public:
    /** @param recording poses of the trajectory to replay, for that type of motion
     * Throws std::runtime_error if the motion comes too close to a surface, with the time and the
     * place. */
    explicit Simulator(const Scenario& scenario, const std::vector<RecordedPose>& recording = {});

    const Motion& motion() const { return motion_; }
    const Scene& scene() const { return scene_; }
    const Lidar& lidar() const { return lidar_; }
    const ImuRecording& imu() const { return imu_; }
    int sweeps() const { return lidar_.sweeps(scenario_.duration); }
    SimulatedScan sweep(int k, Executor& executor) const;

 private:
    struct Stage
    {
        Scene scene;
        Motion motion;
    };
    static Stage makeStage(const Scenario& scenario, const std::vector<RecordedPose>& recording);
    Simulator(const Scenario& scenario, Stage stage);
    void checkClearance() const;

    Scenario scenario_;
    Scene scene_;
    Motion motion_;
    ImuRecording imu_;
    Lidar lidar_;
};
}  // namespace taut::simulation
