#include "RingShape.h"

#include <algorithm>
#include <cmath>

#include "Rings.h"

namespace taut
{
namespace
{
constexpr double kMaxNeighbourAngle = 0.04;  // [rad]: of near points, not the spacing is kept
constexpr double kEdgeSigmas = 4;            // more than noise makes of a plane
constexpr double kSteadySlope = 3;      // a step in range is this much larger than those beside it
constexpr std::size_t kRimSupport = 2;  // steps of a surface that must lie beside its rim
constexpr float kRimCurvature = 1;      // ranks a rim with the right angles

/** One ring under analysis. Pair i is that of points i and i + 1. */
class Ring
{
 public:
    Ring(
        const Scan& scan, const PointIndices& points, double angular_step,
        const CurvatureExtractor::Config& config)
        : scan_(scan),
          points_(points),
          config_(config),
          angular_step_(angular_step),
          tan_incidence_(std::tan(config.max_incidence * M_PI / 180))
    {
        sums_.reserve(size() + 1);
        ranges_.reserve(size());
        angles_.reserve(size());
        breaks_.reserve(size());
        sums_.emplace_back(Vector3d::Zero());
        for (std::size_t i = 0; i < size(); i++)
        {
            const Vector3d position = point(i).position.cast<double>();
            sums_.emplace_back(sums_.back() + position);
            ranges_.push_back(position.norm());
        }
        for (std::size_t i = 0; i + 1 < size(); i++)
            angles_.push_back(angleBetween(point(i), point(i + 1)));
        breaks_.push_back(0);
        for (std::size_t i = 0; i + 1 < size(); i++)
            breaks_.push_back(breaks_.back() + (isGap(i) || isOcclusion(i) ? 1 : 0));
    }

    std::size_t size() const { return points_.size(); }

    /** The shape around point i, from neighbours of the wanted size or, where these reach beyond
     * the surface, from single points. */
    Shape shapeAt(std::size_t i, float& curvature) const
    {
        const std::size_t half = neighbourSize(i) / 2;
        if (isWhole(i, half)) return shapeAt(i, half, curvature);
        return isWhole(i, 0) ? shapeAt(i, 0, curvature) : Shape::Unknown;
    }

    /** Is point i, an edge, less curved than another close by, or closer to where nothing is known?
     */
    bool isShoulder(std::size_t i, const RingShape& result) const
    {
        const std::size_t near = 2 * neighbourSize(i);
        if (i < near || i + near >= size()) return true;
        for (std::size_t k = i - near; k <= i + near; k++)
            if (result.shape[k] == Shape::Unknown || result.curvature[k] > result.curvature[i])
                return true;
        return false;
    }

    /** Is point i the last of a surface in front of another? */
    bool isRim(std::size_t i) const
    {
        if (i < kRimSupport || i + kRimSupport >= size()) return false;
        const bool ends = broken(i, i + 1) && ranges_[i] < ranges_[i + 1] && !isGap(i) &&
                          isSurface(i, i - kRimSupport, i);
        const bool begins = broken(i - 1, i) && ranges_[i] < ranges_[i - 1] && !isGap(i - 1) &&
                            isSurface(i, i, i + kRimSupport);
        return ends || begins;
    }

 private:
    const LidarPoint& point(std::size_t i) const { return scan_.points[points_[i]]; }
    double change(std::size_t pair) const { return std::abs(ranges_[pair + 1] - ranges_[pair]); }

    /** Mean of the points [from, to). */
    Vector3d mean(std::size_t from, std::size_t to) const
    {
        return (sums_[to] - sums_[from]) / static_cast<double>(to - from);
    }

    /** Is there no surface somewhere between two points? */
    bool broken(std::size_t from, std::size_t to) const { return breaks_[from] != breaks_[to]; }

    /** Odd number of points whose mean is one neighbour of point i. */
    std::size_t neighbourSize(std::size_t i) const
    {
        const double across = ranges_[i] * kMaxNeighbourAngle > config_.neighbour_spacing
                                  ? config_.neighbour_spacing / ranges_[i]
                                  : kMaxNeighbourAngle;
        return 1 + 2 * static_cast<std::size_t>(std::max(0.0, across / angular_step_ / 2));
    }

    /** Are returns missing, so many that nothing is known of the surface? */
    bool isGap(std::size_t pair) const
    {
        return angles_[pair] > (config_.neighbours + 0.5) * angular_step_;
    }

    /** A step in range that neither a surface at the largest incidence makes nor the slope beside.
     */
    bool isOcclusion(std::size_t pair) const
    {
        const double before = pair > 0 ? change(pair - 1) : 0;
        const double after = pair + 2 < size() ? change(pair + 1) : 0;
        const double nearer = std::min(ranges_[pair], ranges_[pair + 1]);
        return change(pair) > config_.occlusion_step + std::min(
                                                           kSteadySlope * std::max(before, after),
                                                           tan_incidence_ * nearer * angles_[pair]);
    }

    /** Are all points that a neighbourhood of 2 half + 1 points a neighbour needs on one surface?
     */
    bool isWhole(std::size_t i, std::size_t half) const
    {
        const std::size_t far = reach(half);
        return i >= far && i + far < size() && !broken(i - far, i + far);
    }
    std::size_t reach(std::size_t half) const
    {
        return static_cast<std::size_t>(config_.neighbours) * (2 * half + 1) + half;
    }

    Shape shapeAt(std::size_t i, std::size_t half, float& curvature) const
    {
        const std::size_t far = reach(half);
        const Vector3d here = mean(i - half, i + half + 1);
        const Vector3d before = mean(i - far, i - half) - here;
        const Vector3d after = mean(i + half + 1, i + far + 1) - here;
        const Vector3d chord = after - before;
        const double half_chord = chord.norm() / 2;
        if (half_chord == 0 || (isGrazing(here, before) && isGrazing(here, after)))
            return Shape::Unknown;

        // Across the chord only: neighbours on a slanted plane are unevenly spaced along it.
        const double bend = (before + after).cross(chord).norm() / (4 * half_chord);
        const double noise = config_.range_noise / std::sqrt(2.0 * static_cast<double>(half) + 1);
        curvature = static_cast<float>(bend / half_chord);
        if (bend > std::max(config_.edge_curvature * half_chord, kEdgeSigmas * noise))
            return Shape::Edge;
        return bend < std::max(config_.plane_curvature * half_chord, noise) ? Shape::Plane
                                                                            : Shape::Curved;
    }

    /** Do the points [from, to] make a surface, seen well from point i at one end? */
    bool isSurface(std::size_t i, std::size_t from, std::size_t to) const
    {
        const Vector3d here = mean(i, i + 1);
        return !broken(from, to) && !isGrazing(here, mean(from, to + 1) - here);
    }

    /** Is the surface from a point towards `side` almost parallel to the beam? */
    bool isGrazing(const Vector3d& here, const Vector3d& side) const
    {
        return std::abs(side.dot(here)) > tan_incidence_ * side.cross(here).norm();
    }

    const Scan& scan_;
    const PointIndices& points_;
    const CurvatureExtractor::Config& config_;
    double angular_step_, tan_incidence_;
    std::vector<double> ranges_;
    std::vector<double> angles_;  // between the beams of each pair
    std::vector<Vector3d> sums_;  // of the points before each
    std::vector<int> breaks_;     // number of broken pairs before each point
};
}  // namespace

RingShape shapeOfRing(
    const Scan& scan, PointIndices points, double angular_step,
    const CurvatureExtractor::Config& config)
{
    const Ring ring(scan, points, angular_step, config);
    RingShape result;
    result.shape.resize(points.size(), Shape::Unknown);
    result.curvature.resize(points.size(), 0);
    if (angular_step > 0)
        for (std::size_t i = 0; i < points.size(); i++)
            result.shape[i] = ring.shapeAt(i, result.curvature[i]);
    for (std::size_t i = 0; i < points.size(); i++)
        if (result.shape[i] == Shape::Edge && ring.isShoulder(i, result))
            result.shape[i] = Shape::Curved;
    for (std::size_t i = 0; i < points.size(); i++)
        if (ring.isRim(i))
        {
            result.shape[i] = Shape::Edge;
            result.curvature[i] = kRimCurvature;
        }
    result.points = std::move(points);
    return result;
}
}  // namespace taut
