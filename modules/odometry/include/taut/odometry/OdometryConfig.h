#pragma once

#include "taut/core/Config.h"
#include "taut/core/FeatureExtractor.h"
#include "taut/core/Imu.h"
#include "taut/core/Map.h"
#include "taut/core/Plugins.h"
#include "taut/core/Preintegrator.h"
#include "taut/core/Solver.h"
#include "taut/factors/LidarFactor.h"
#include "taut/odometry/transformScan.h"
#include "taut/preintegration/Declipper.h"
#include "taut/preintegration/Initializer.h"

namespace taut
{
/** What becomes of the previous state while a scan is matched. */
enum class PreviousState
{
    Fixed,     //!< the paper: held, its uncertainty carried by the IMU factor's covariance
    Released,  //!< estimated together with the new one, then marginalised
};

struct EstimationConfig
{
    Undistortion undistortion = Undistortion::Bridge;
    PreviousState previous_state = PreviousState::Released;
    int max_iterations = 8;               //!< look-ups of correspondences
    int max_iterations_without_imu = 30;  //!< the same where the rate is a state
    /** Sigmas, whitened step after which matches are not renewed. Smaller ones change nothing that
     * can be measured, and cost a sixth of the time. */
    double min_step = 0.1;
    int min_correspondences = 30;  //!< fewer are not believed: the IMU alone moves the state
    bool balance = true;           //!< scale the LiDAR noise by its own reduced chi-square
    int balance_min_matches = 200;
    double inflation = 1.0;  //!< factor on the LiDAR noise for what its residuals share

    /** Share of the matches' information on the position that lies along a direction: below the
     * first it counts as nothing, from the second on as what it is. 0: all of it counts. */
    double open_share = 0, shown_share = 1e-3;

    // Absolute prior of the biases, renewed once in `bias_time`.
    double accel_bias_sigma = 0.2;  //!< [m/s^2]
    double gyro_bias_sigma = 0.02;  //!< [rad/s]
    double bias_time = 30.0;        //!< [s]

    // Bounds of one step.
    double max_step_position = 1.0;  //!< [m]
    double max_step_velocity = 5.0;  //!< [m/s]
    double max_step_rotation = 0.3;  //!< [rad]
    double max_step_bias_accel = 0.5;
    double max_step_bias_gyro = 0.1;

    void declare(ConfigSection& section);
};

struct MapInsertConfig
{
    int max_points = 20000;  //!< of one scan: evenly thinned above
};

/** All choices of a method, with prototypes of the plug points: what a method file says. A value:
 * copies share nothing that changes. */
struct OdometryConfig
{
    EstimationConfig estimation;
    InitializationConfig initialization;
    LidarNoiseConfig lidar_noise;
    ImuNoise imu_noise;
    ImuRange imu_range;
    bool imu_noise_from_rest = true;  //!< raise the white noise to what is seen at rest
    RangeConfig range;
    MapInsertConfig insert;
    bool keep_undistorted = false;  //!< fill ScanResult::undistorted; for programs, not a key
    double imu_wait = 1.0;  //!< [s] of scans without an IMU sample after which nobody waits for one

    Prototype<Preintegrator> preintegrator;
    Prototype<Preintegrator> fallback_preintegrator;  //!< for times without an IMU
    Prototype<FeatureExtractor> extractor;
    Prototype<Solver> solver;
    Prototype<Map> map;

    /** Reads all sections and creates the plug points. Throws ConfigError. */
    static OdometryConfig read(ConfigSection& root);
};
}  // namespace taut
