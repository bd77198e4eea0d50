#pragma once

#include <cstdint>
#include <vector>

#include "taut/core/NavState.h"
#include "taut/core/PoseGraph.h"
#include "taut/core/RangeImage.h"

/** \file Submap.h
 * A submap is what consecutive scans saw, in a frame of its own. Its frame has the position and the
 * heading of the body at its first state; its z axis points up. */
namespace taut
{
struct SubmapPoint
{
    Eigen::Vector3f position;  //!< submap frame [m]
    std::uint16_t scan = 0;    //!< which of Submap::scans saw it
};

/** The end state of a scan, as the odometry left it, in the frame of its submap. */
struct SubmapScan
{
    Time t = 0;
    Pose T_submap_imu;
    /** Covariance of what the odometry has gained in error from the first state of the submap to
     * here: of d = (p, theta) with T = Exp(d) T_submap_imu, in the submap's frame [m, rad]. It
     * grows from scan to scan. Exp(d) T = {Exp(theta) R, Exp(theta) t + p}. */
    Matrix6d covariance = Matrix6d::Zero();
};

/** What one scan saw, by direction. */
struct KeyScan
{
    std::uint16_t scan = 0;  //!< which of Submap::scans it was
    Pose T_submap_sensor;
    double blur = 0;  //!< [m] way of the sensor during the scan: rays begin that far off
    RangeImage image;
};

struct Submap
{
    VertexId id = 0;
    Pose T_world_submap;  //!< as the odometry has it
    /** Direction of up, and how well it is known [rad^2]: what a GravityEdge says. */
    Vector3d up_submap = Vector3d::UnitZ();
    Matrix3d up_covariance = Matrix3d::Identity();
    double path_begin = 0, path_end = 0;  //!< [m] way of the body from the start of the recording
    double reach = 0;                 //!< [m] most points lie nearer to where they were seen from
    bool doubtful = false;            //!< the pose was in doubt during a part of it
    std::vector<SubmapScan> scans;    //!< scans[0]: its first state, the last of the submap before
    std::vector<SubmapPoint> points;  //!< undistorted and thinned
    std::vector<KeyScan> key_scans;

    /** The last state: the first of the submap after it. */
    const SubmapScan& last() const { return scans.back(); }
};
}  // namespace taut
