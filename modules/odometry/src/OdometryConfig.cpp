#include "taut/odometry/OdometryConfig.h"

#include "taut/core/Plugins.h"

namespace taut
{
void EstimationConfig::declare(ConfigSection& s)
{
    declareUndistortion(s, undistortion);
    s.choice<PreviousState>(
        "previous_state", previous_state,
        {{"fixed", PreviousState::Fixed}, {"released", PreviousState::Released}},
        "held under its covariance, or estimated together with the new state");
    s.key("max_iterations", max_iterations, {1, 100}, "look-ups of correspondences");
    s.key(
        "max_iterations_without_imu", max_iterations_without_imu, {1, 100},
        "the same where no IMU tells where to begin");
    s.key("min_step", min_step, kPositive, "sigmas, step after which matches are not renewed");
    s.key("min_correspondences", min_correspondences, {6, 1e6}, "fewer are not believed");
    s.key("balance", balance, "scale the LiDAR noise by its own reduced chi-square");
    s.key("balance_min_matches", balance_min_matches, {1, 1e6}, "fewest matches to do so");
    s.key("inflation", inflation, kPositive, "factor on the LiDAR noise for what residuals share");
    s.key(
        "open_share", open_share, {0, 0.3},
        "share of the information on the position: a direction with less is open; 0: none is");
    s.key("shown_share", shown_share, {1e-9, 0.34}, "the same: one that has more is believed");
    if (!(open_share < shown_share))
        throw ConfigError("estimation.open_share has to be below estimation.shown_share");
    s.key("accel_bias_sigma", accel_bias_sigma, kPositive, "m/s^2, absolute prior");
    s.key("gyro_bias_sigma", gyro_bias_sigma, kPositive, "rad/s, absolute prior");
    s.key("bias_time", bias_time, kPositive, "s, in which the absolute prior is renewed once");
    s.key("max_step_position", max_step_position, kPositive, "m, bound of one step");
    s.key("max_step_velocity", max_step_velocity, kPositive, "m/s");
    s.key("max_step_rotation", max_step_rotation, kPositive, "rad");
    s.key("max_step_bias_accel", max_step_bias_accel, kPositive, "m/s^2");
    s.key("max_step_bias_gyro", max_step_bias_gyro, kPositive, "rad/s");
}

OdometryConfig OdometryConfig::read(ConfigSection& root)
{
    OdometryConfig c;
    c.estimation.declare(root.section("estimation"));
    c.initialization.declare(root.section("initialization"));

    ConfigSection& lidar = root.section("lidar");
    lidar.key("sigma", c.lidar_noise.sigma, kNotNegative, "m, noise besides the map's");
    c.lidar_noise.kernel.declare(lidar);
    lidar.key("min_range", c.range.min, kNotNegative, "m, nearer returns are of the carrier");
    lidar.key("max_range", c.range.max, kPositive, "m");
    lidar.key("max_insert_points", c.insert.max_points, {100, 1e7}, "of one scan into the map");

    ConfigSection& imu = root.section("imu");
    imu.key("gyro_noise", c.imu_noise.gyro, kPositive, "rad/s/sqrt(Hz)");
    imu.key("accel_noise", c.imu_noise.accel, kPositive, "m/s^2/sqrt(Hz)");
    imu.key("gyro_bias_walk", c.imu_noise.gyro_bias_walk, kPositive, "rad/s^2/sqrt(Hz)");
    imu.key("accel_bias_walk", c.imu_noise.accel_bias_walk, kPositive, "m/s^3/sqrt(Hz)");
    imu.key("noise_from_rest", c.imu_noise_from_rest, "raise the white noise to that seen at rest");
    c.imu_range.declare(imu);
    imu.key(
        "wait", c.imu_wait, kPositive,
        "s of scans without an IMU sample: then constant velocity takes over");

    c.preintegrator = Prototype<Preintegrator>(createConfigured<Preintegrator>(
        root.section("preintegration"), "taut::MidpointPreintegrator"));
    c.fallback_preintegrator = Prototype<Preintegrator>(createConfigured<Preintegrator>(
        root.section("without_imu"), "taut::ConstantVelocityPreintegrator"));
    c.extractor = Prototype<FeatureExtractor>(
        createConfigured<FeatureExtractor>(root.section("features"), "taut::VoxelThinning"));
    c.solver =
        Prototype<Solver>(createConfigured<Solver>(root.section("solver"), "taut::GaussNewton"));
    c.map = Prototype<Map>(createConfigured<Map>(root.section("map"), "taut::OctreeMap"));
    return c;
}
}  // namespace taut
