#pragma once

#include <vector>

#include "taut/core/Map.h"
#include "taut/core/PoseGraph.h"
#include "taut/core/Submap.h"

namespace taut
{
/** Points of a submap as queries or content of a map, in its frame, seen from where they were seen
 * from. At most `most`, evenly taken. */
std::vector<MapPoint> mapPointsOf(const Submap& submap, std::size_t most);

/** Where the points of one submap lie on the surfaces of another. */
struct SubmapFit
{
    Pose T_from_to;
    /** Hessian of the cost by d of T_from_to Exp(d), in whitened residuals [1/m^2, 1/rad^2]. */
    Matrix6d hessian = Matrix6d::Zero();
    int matched = 0;      //!< points with a surface near
    double weight = 0;    //!< of these, explained by it: the sum of robust weights
    double residual = 0;  //!< [m] root mean square, by the robust weights
    bool converged = false;

    /** Share of the points that a surface explains. */
    double share(std::size_t points) const
    {
        return points > 0 ? weight / static_cast<double>(points) : 0;
    }
};

/** Point-to-surface registration of one submap on another by Gauss-Newton. Residuals count by
 * Geman and McClure's kernel, whose width shrinks from one iteration to the next: wide enough for
 * the first guess at the beginning, as narrow as the surfaces are thick at the end. */
class SubmapRegistration
{
 public:
    /** `map`: of the points of submap `from`, in its frame. All references are kept. */
    SubmapRegistration(const Map& map, Executor& executor) : map_(map), executor_(executor) {}

    /** `points`: of submap `to`, in its frame; `width` [m]: how far off the guess may be. */
    SubmapFit align(const std::vector<MapPoint>& points, const Pose& guess, double width);

    /** How many of the points a surface explains, by a kernel of that width [m]. */
    double inlierWeight(const std::vector<MapPoint>& points, const Pose& T_from_to, double width);

    /** Normals of the surfaces that points of submap `from` itself lie on, in its frame; zero where
     * there is none. */
    std::vector<Vector3d> normalsOf(const std::vector<MapPoint>& points_of_from);

    /** Whether each of the points lies on a surface: its distance is within three deviations. */
    std::vector<bool> onSurface(const std::vector<MapPoint>& points, const Pose& T_from_to);

 private:
    void match(const std::vector<MapPoint>& points, const Pose& T_from_to);

    const Map& map_;
    Executor& executor_;
    MapScratch scratch_;
    std::vector<MapPoint> queries_;
    std::vector<Correspondence> found_;
};

/** Middle of points and their root mean square distance from it, not below 1 m. */
struct Extent
{
    Vector3d middle = Vector3d::Zero();
    double lever = 1;
};
Extent extentOf(const std::vector<MapPoint>& points);

/** Eigenvectors of a Hessian where rotations and positions part: around the middle of the points,
 * rotations told in metres at their distance from it. d = basis * coordinates. */
struct PoseDirections
{
    Matrix6d basis;
    Vector6d shown;    //!< eigenvalues [1/m^2], ascending
    double lever = 1;  //!< [m]
    Matrix6d axes;     //!< eigenvectors in coordinates (position [m], rotation [m at the lever])

    /** Share of all that is shown, which says anything of that direction. Less is what normals that
     * err by a degree or four would show of a direction that has nothing to show. */
    bool isOpen(int i) const { return !(shown[i] > 0.005 * shown.sum()); }
};
PoseDirections directionsOf(const Matrix6d& hessian, const Extent& extent);

/** Residual of a point x of `to` and its derivative by d of T_from_to Exp(d): n . (R x + p - c) for
 * a plane. */
struct PointResidual
{
    double residual = 0;
    Vector6d derivative;
};
PointResidual planeResidual(const Pose& T_from_to, const Vector3d& x, const Correspondence& plane);
}  // namespace taut
