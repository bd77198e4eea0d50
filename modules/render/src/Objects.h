#pragma once

#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <vector>

#include "taut/render/HeightColors.h"
#include "taut/render/PointCloud.h"
#include "taut/render/ViewCamera.h"

/** \file Objects.h
 * What is put into a scene, as MRPT's objects in the frame of the camera. */
namespace taut
{
/** The points coloured by height, as dots of that size [m], within reasonable bounds in pixels: one
 * cloud for each size in pixels that occurs. */
std::vector<mrpt::opengl::CPointCloudColoured::Ptr> makeClouds(
    const PointCloud& points, const Span& heights, const ViewCamera& camera, double dot_size,
    int supersampling);

/** Lines at the multiples of `step` on the plane at height z, over that ground and one step more.
 */
mrpt::opengl::CSetOfLines::Ptr makeGrid(
    const Span& x, const Span& y, double z, double step, const ViewCamera& camera);

/** Round solids made of triangles, given in the world frame. MRPT's lines have no width. */
class Solids
{
 public:
    explicit Solids(const ViewCamera& camera);

    void addSphere(const Vector3d& center, double radius, const Rgb& color);
    void addTube(const Vector3d& from, const Vector3d& to, double radius, const Rgb& color);

    /** A tube along the path; steps shorter than the radius are drawn as one. */
    void addPath(const std::vector<Pose>& trajectory, double radius, const Rgb& color);

    /** The axes of a frame: x red, y green, z blue. */
    void addAxes(const Pose& T_world_frame, double length, double radius);

    const mrpt::opengl::CSetOfTriangles::Ptr& object() const { return triangles_; }

 private:
    ViewCamera camera_;
    mrpt::opengl::CSetOfTriangles::Ptr triangles_;
};
}  // namespace taut
