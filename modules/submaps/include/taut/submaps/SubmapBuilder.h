#pragma once

#include <functional>
#include <optional>

#include "taut/core/Config.h"
#include "taut/core/NavState.h"
#include "taut/core/Submap.h"
#include "taut/core/ThinnedSample.h"
#include "taut/core/VoxelSet.h"

namespace taut
{
struct SubmapConfig
{
    // A submap ends where the body is that far from its begin and has taken that long, or at last.
    double length_share = 0.5;                   //!< of the median range of its points
    double min_length = 8, max_length = 60;      //!< [m]
    double min_duration = 8, max_duration = 60;  //!< [s]

    double point_spacing = 0.1;  //!< [m] one point a voxel of this size
    int max_points = 60000;      //!< of a submap; evenly thinned above
    double key_distance = 3;     //!< [m] or
    double key_angle = 0.35;     //!< [rad] from one key scan to the next

    /** What the odometry drifts besides what its covariance says: errors of the sensors that do not
     * average out. Shares of the way, or of the angle turned, within one submap. */
    double drift_position = 0.002;  //!< [m/m]
    double drift_rotation = 3e-5;   //!< [rad/m]
    double drift_turn = 0.001;      //!< [rad/rad]
    double tilt_sigma = 0.002;      //!< [rad] of up, as the odometry knows it, at least
    // While the pose is in doubt.
    double doubt_speed = 1;   //!< [m/s]
    double doubt_rate = 0.2;  //!< [rad/s]

    void declare(ConfigSection& section);
};

/** Cuts the states and points of an odometry into submaps. Not thread-safe. */
class SubmapBuilder
{
 public:
    /** `done` gets every submap when it ends, in their order. */
    SubmapBuilder(const SubmapConfig& config, std::function<void(Submap)> done);

    /** For a recording that goes on from others: the id of its first submap, and the way [m] that
     * it begins at. */
    void goOnFrom(VertexId first_id, double path)
    {
        next_id_ = first_id;
        path_ = path;
    }

    /** The first state, or a new beginning. */
    void start(const NavEstimate& first);

    /** The next final state with the points of its sweep (world frame, [m]). `T_imu_lidar` tells
     * where rays begin. */
    void add(
        const NavEstimate& estimate, const std::vector<Vector3d>& points_world,
        const Pose& T_imu_lidar);

    /** From here on the pose is in doubt, or no more: the submap ends. */
    void setDoubt(bool doubtful);

    /** Ends the last submap. */
    void finish();

 private:
    void begin(const NavEstimate& first);
    void end();
    bool isComplete() const;
    Matrix6d stepCovariance(const NavEstimate& estimate);
    void addPoints(const std::vector<Vector3d>& points_world);
    void addKeyScan(
        const std::vector<Vector3d>& points_world, const Pose& T_world_sensor, double blur);

    SubmapConfig config_;
    std::function<void(Submap)> done_;
    std::optional<Submap> submap_;
    NavEstimate last_;
    bool doubtful_ = false;
    VertexId next_id_ = 0;
    double path_ = 0;              // [m] from the first state of all
    double way_ = 0, turned_ = 0;  // [m, rad] within the submap
    VoxelSet voxels_;
    ThinnedSample<SubmapPoint> points_;
    ThinnedSample<double> ranges_;  // [m]
    Pose last_key_;                 // T_world_sensor
};
}  // namespace taut
