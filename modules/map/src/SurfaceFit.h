#pragma once

#include <Eigen/Eigenvalues>
#include <vector>

#include "taut/core/Correspondence.h"

namespace taut
{
/** Lines and planes through a few points [m], by the eigenvalues of their scatter. */
class SurfaceFit
{
 public:
    /** Of `count` points, 3 at least. */
    SurfaceFit(const Vector3d* points, std::size_t count);

    /** Surface::None if the points make no line: the scatter along it is not `ratio` times that
     * across, or a point is further than `tolerance` [m] from it. The sigma is that at `query`. */
    Correspondence line(const Vector3d& query, double ratio, double tolerance) const;

    /** Surface::None if the points make no plane: they lie in a row, spread by less than
     * `min_spread` [m, standard deviation] beside it, or a point is further than `tolerance` [m]
     * from the plane. */
    Correspondence plane(const Vector3d& query, double min_spread, double tolerance) const;

 private:
    /** Uncertainty of the mean and of the directions along, at a query, in units of the thickness.
     */
    double leverage(const Vector3d& query, int first_axis) const;

    const Vector3d* points_;
    std::size_t count_;
    Vector3d mean_ = Vector3d::Zero();
    Vector3d variances_;  // ascending
    Matrix3d axes_;       // in that order
};
}  // namespace taut
