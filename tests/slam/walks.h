#pragma once

#include <functional>
#include <vector>

#include "scenes.h"
#include "taut/map/OctreeMap.h"
#include "taut/slam/Mapper.h"
#include "taut/submaps/SubmapBuilder.h"

/** \file walks.h
 * A LiDAR that is carried through a scene, and an odometry that drifts. */
namespace taut::test
{
/** A corridor around a block, with things standing in it: 40 x 30 m, 5 m wide. */
inline Scene ring()
{
    Scene scene;
    scene.room = {{-20, -15, 0}, {20, 15, 3}};
    scene.obstacles = {{{-15, -10, 0}, {15, 10, 3}},     {{-19, -15, 0}, {-18, -13.5, 2}},
                       {{-6, -15, 0}, {-4.5, -14, 1.2}}, {{7, -10.6, 0}, {8, -10, 2.2}},
                       {{19, -4, 0}, {20, -2, 1.6}},     {{15, 5, 0}, {15.5, 7, 2.5}},
                       {{11, 14, 0}, {12, 15, 2}},       {{-3, 10, 0}, {-1, 10.5, 1.5}},
                       {{-12, 14.3, 0}, {-9, 15, 1}},    {{-20, 3, 0}, {-19.2, 5, 1.8}}};
    return scene;
}

/** Where a walk round the ring is after so many metres; 1.2 m above the floor. */
inline Pose aroundRing(double way)
{
    constexpr double kLong = 35, kShort = 25;
    way = std::fmod(way, 2 * (kLong + kShort));
    if (way < kLong) return {expSO3({0, 0, 0}), {-17.5 + way, -12.5, 1.2}};
    way -= kLong;
    if (way < kShort) return {expSO3({0, 0, M_PI / 2}), {17.5, -12.5 + way, 1.2}};
    way -= kShort;
    if (way < kLong) return {expSO3({0, 0, M_PI}), {17.5 - way, 12.5, 1.2}};
    way -= kLong;
    return {expSO3({0, 0, -M_PI / 2}), {-17.5, 12.5 - way, 1.2}};
}

/** Points of a scan in the frame of the LiDAR. */
inline std::vector<Vector3d> pointsSeenFrom(
    const Scene& scene, const Pose& T_world_lidar, Random& random, int columns = 360)
{
    SpinningLidar lidar;
    lidar.columns = columns;
    const Scene seen = scene.seenFrom(T_world_lidar.p);
    std::vector<Vector3d> points;
    for (int column = 0; column < lidar.columns; column++)
        for (int ring = 0; ring < lidar.rings; ring++)
        {
            const Vector3d d = lidar.direction(ring, column);
            points.push_back((seen.range(T_world_lidar.R * d) + 0.01 * random.normal()) * d);
        }
    return points;
}

/** An odometry that drifts by a scale and a turn a metre. */
struct DriftingOdometry
{
    double scale = 1, turn = 0;  //!< [-], [rad/m]
    Pose truth, estimate;        //!< of the last step

    void start(const Pose& at) { truth = estimate = at; }
    void moveTo(const Pose& next)
    {
        Pose step = truth.inverse() * next;
        step.R = step.R * expSO3({0, 0, turn * step.p.norm()});
        step.p *= scale;
        estimate = estimate * step;
        truth = next;
    }
};

inline NavEstimate estimateAt(Time t, const Pose& pose)
{
    NavEstimate e;
    e.state.t = t;
    e.state.T_world_imu = pose;
    e.covariance = 1e-8 * NavState::Matrix::Identity();
    return e;
}

/** Configuration of all that a Mapper needs, with defaults. */
inline SlamConfig slamConfig()
{
    SlamConfig config;
    config.map = Prototype<Map>(std::make_shared<OctreeMap>());
    return config;
}

/** Carries the LiDAR along poses, one scan each half metre, and tells `add` what the odometry
 * makes of it. */
inline void carry(
    const Scene& scene, const std::function<Pose(double)>& way, double length,
    DriftingOdometry& odometry, Random& random,
    const std::function<void(const NavEstimate&, const std::vector<Vector3d>&)>& add,
    double step = 0.5)
{
    Time t = 1'700'000'000'000'000'000;
    for (double s = step; s <= length; s += step)
    {
        odometry.moveTo(way(s));
        t += fromSeconds(step);  // 1 m/s
        std::vector<Vector3d> points = pointsSeenFrom(scene, odometry.truth, random);
        for (Vector3d& p : points) p = odometry.estimate * p;
        add(estimateAt(t, odometry.estimate), points);
    }
}

/** The submap that a walk leaves which begins at `from` metres of a way and is `length` long. */
inline Submap submapOf(
    const Scene& scene, const std::function<Pose(double)>& way, double from, double length,
    unsigned seed)
{
    SubmapConfig config;
    config.min_length = config.max_length = 1e3;
    config.max_duration = 1e6;
    std::vector<Submap> submaps;
    SubmapBuilder builder(config, [&](Submap s) { submaps.push_back(std::move(s)); });
    DriftingOdometry odometry;
    odometry.start(way(from));
    Random random(seed);
    builder.start(estimateAt(1'700'000'000'000'000'000, odometry.estimate));
    carry(
        scene, [&](double s) { return way(from + s); }, length, odometry, random,
        [&](const NavEstimate& e, const std::vector<Vector3d>& p) { builder.add(e, p, {}); });
    builder.finish();
    return submaps.at(0);
}
}  // namespace taut::test
