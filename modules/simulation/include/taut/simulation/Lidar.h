#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "taut/core/Config.h"
#include "taut/core/Parallel.h"
#include "taut/core/Scan.h"
#include "taut/simulation/BeamErrors.h"
#include "taut/simulation/LidarPattern.h"
#include "taut/simulation/Motion.h"
#include "taut/simulation/Mount.h"
#include "taut/simulation/PacketLoss.h"
#include "taut/simulation/Scene.h"
#include "taut/simulation/Weather.h"

namespace taut::simulation
{
enum class LidarType
{
    Vlp16,
    Hdl32,
    Hdl64,
    Os1_64,
    Os1_128,
    Rosette,  //!< Livox-like
};

/** What carries the LiDAR and stands in its view. */
enum class OwnBody
{
    None,
    Person,       //!< somebody who holds it before the chest
    Car,          //!< on the roof
    Multicopter,  //!< under it, upside down
};

/** What a LiDAR measures, and how well. */
struct LidarConfig
{
    LidarType type = LidarType::Vlp16;
    double rotation_rate = 10;   //!< sweeps a second [Hz]
    double min_range = 0.5;      //!< [m]
    double max_range = 100;      //!< [m]
    double range_noise = 0.02;   //!< standard deviation [m]
    double range_step = 0;       //!< resolution of the ranges; 0 = as fine as float [m]
    double detection_range = 0;  //!< at which half of the shots at a white wall return; 0 = all [m]
    double dropout = 0;          //!< part of the shots lost for no reason
    double divergence = 0;       //!< full angle of the beam; 0 = a line without mixed pixels [rad]
    /** Constant errors of a unit, see BeamErrors. */
    double beam_error = 0;        //!< of the elevation of each ring, standard deviation [rad]
    double beam_range_error = 0;  //!< of the ranges of each ring, standard deviation [m]
    double range_bias = 0;        //!< of all ranges; > 0 measures long [m]
    /** Ranges that depend on what is met. The darker, the longer: by so much where no light comes
     * back, by nothing at a white surface head-on [m]. */
    double intensity_error = 0;
    /** Part of half the depth of the footprint, range * tan(incidence) * divergence / 2 and at most
     * 0.25 m, by which ranges are too long; < 0 = too short. */
    double incidence_error = 0;
    PacketLoss packet_loss;
    OwnBody own_body = OwnBody::None;
    Pose T_imu_lidar;  //!< as the recording tells
    Pose mount_error;  //!< frame of the true LiDAR in that of T_imu_lidar
    SoftMount soft_mount;
};

LidarConfig lidarPreset(LidarType type);
void declare(ConfigSection& section, LidarConfig& config);

/** A scan with the truth of each of its points. */
struct SimulatedScan
{
    Scan scan;  //!< stamp: time of the first shot of the sweep; times since the start of the
                //!< simulation
    /** undistorted(), without the errors of beams and mount; whatever else changes a range stays in
     * it, as the noise does. */
    std::vector<Eigen::Vector3f> truth;
    /** What the middle of the beam met, world frame, at the time of the point. */
    std::vector<Vector3d> surface;
};

/** Each point of a scan in the IMU frame at scan.end, moved there by the true motion. The scan's
 * times are ahead of the motion's by `clock`. */
std::vector<Eigen::Vector3f> undistorted(
    const Scan& scan, const Motion& motion, Duration clock = 0);

/** Casts the shots of a LiDAR that moves through a world, each at its own time. */
class Lidar
{
 public:
    Lidar(const LidarConfig& config, std::uint64_t seed, const WeatherConfig& weather = {});

    /** Number of whole sweeps in [0, duration]; the first starts at kStart. */
    int sweeps(double duration) const;

    /** Sweep k. The same bits with any number of threads. Scan::end is the time of the last point.
     */
    SimulatedScan sweep(int k, const Motion& motion, const Scene& scene, Executor& executor) const;

    const BeamErrors& beamErrors() const { return beam_errors_; }
    const Mount& mount() const { return mount_; }

    /** Where recorded points would be without the errors of beams and mount. The scan's times are
     * ahead of the motion's by `clock`; its beams start in the sensor's origin. */
    Scan withoutErrors(Scan recorded, Duration clock) const;

    static constexpr Duration kStart = 20'000'000;  //!< the IMU is there first [ns]

 private:
    struct Return;
    struct Luck;
    std::vector<Return> castAll(
        const std::vector<Shot>& shots, int k, const Motion& motion, const Scene& scene,
        Executor& executor) const;

    /** What one shot gives, but for its offset within the sweep. */
    std::optional<Return> measure(
        const Shot& shot, const Luck& luck, const Motion& motion, const Scene& scene) const;
    double rangeOf(
        const Hit& hit, const Shot& shot, double noise, double light, double cosine) const;
    void losePackets(std::vector<Return>& returns, int k) const;

    LidarConfig config_;
    WeatherConfig weather_;
    std::uint64_t seed_;
    std::unique_ptr<LidarPattern> pattern_;
    BeamErrors beam_errors_;
    Mount mount_;
    std::optional<RayCaster> own_body_;
};
}  // namespace taut::simulation
