#pragma once

#include "taut/simulation/Mesh.h"
#include "taut/simulation/Random.h"

/** \file Plants.h
 * Things that stand about outdoors. */
namespace taut::simulation
{
struct Tree
{
    double height, radius;  //!< of the trunk [m]
    double crown_bottom;    //!< over the foot [m]
    double crown_radius;    //!< [m]
    int leaves;             //!< triangles of about 0.4 m, so that some light passes the crown
};

/** A tree at `foot`, a little crooked, rooted 0.4 m deep. */
void addTree(Mesh& mesh, const Vector3d& foot, const Tree& tree, Random& random);

/** Loose triangles of size `edge` in an ellipsoid. */
void addLeaves(
    Mesh& mesh, const Vector3d& center, const Vector3d& radii, int count, double edge,
    Random& random);

/** A parked car, along x of T, of about 4.3 m times `scale`, standing on T.p. */
void addCar(Mesh& mesh, const Pose& T, float reflectivity, double scale);
}  // namespace taut::simulation
