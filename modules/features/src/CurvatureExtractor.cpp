#include "taut/features/CurvatureExtractor.h"

#include <algorithm>
#include <utility>

#include "RingShape.h"
#include "Rings.h"

IMPLEMENTS_MRPT_OBJECT(CurvatureExtractor, taut::FeatureExtractor, taut)

namespace taut
{
namespace
{
using Config = CurvatureExtractor::Config;

constexpr int kRelaxations = 4;  // before the whole scan is used

/** Chooses the edges and planes of one ring. */
class RingChooser
{
 public:
    RingChooser(const Scan& scan, const RingShape& ring, const Config& config)
        : scan_(scan), ring_(ring), config_(config), suppressed_(ring.points.size(), false)
    {
    }

    /** Appends the `most` most curved edges or least curved planes of each sector. */
    void choose(Shape shape, int most, PointIndices& chosen)
    {
        const std::size_t size = ring_.points.size();
        const auto sectors = static_cast<std::size_t>(config_.sectors);
        for (std::size_t s = 0; s < sectors; s++)
        {
            int count = 0;
            for (const auto& [rank, i] :
                 rankedPoints(s * size / sectors, (s + 1) * size / sectors, shape))
            {
                if (count == most) break;
                if (suppressed_[i]) continue;
                suppressAround(i);
                chosen.push_back(ring_.points[i]);
                count++;
            }
        }
    }

 private:
    /** Points of that shape with their rank, the first to choose first. */
    std::vector<std::pair<float, std::size_t>> rankedPoints(
        std::size_t begin, std::size_t end, Shape shape) const
    {
        const float sign = shape == Shape::Edge ? -1.0f : 1.0f;
        std::vector<std::pair<float, std::size_t>> ranked;
        ranked.reserve(end - begin);
        for (std::size_t i = begin; i < end; i++)
            if (ring_.shape[i] == shape) ranked.emplace_back(sign * ring_.curvature[i], i);
        std::sort(ranked.begin(), ranked.end());
        return ranked;
    }

    void suppressAround(std::size_t i)
    {
        suppressed_[i] = true;
        for (std::size_t k = 1; k <= i && isClose(i, i - k, k); k++) suppressed_[i - k] = true;
        for (std::size_t k = 1; i + k < suppressed_.size() && isClose(i, i + k, k); k++)
            suppressed_[i + k] = true;
    }

    bool isClose(std::size_t i, std::size_t j, std::size_t steps) const
    {
        return steps <= static_cast<std::size_t>(config_.neighbours) ||
               (position(i) - position(j)).norm() < config_.feature_distance;
    }
    const Eigen::Vector3f& position(std::size_t i) const
    {
        return scan_.points[ring_.points[i]].position;
    }

    const Scan& scan_;
    const RingShape& ring_;
    const Config& config_;
    std::vector<bool> suppressed_;
};

/** The chosen points of a scan. */
struct Choice
{
    PointIndices edges, planes;

    std::size_t size() const { return edges.size() + planes.size(); }
};

/** One more flat point per voxel, none of them chosen before. */
void addFlatPoints(
    const Scan& scan, const std::vector<RingShape>& rings, double voxel_size, PointIndices& planes)
{
    std::vector<bool> chosen(scan.points.size(), false);
    for (const std::uint32_t i : planes) chosen[i] = true;
    PointIndices flat;
    for (const RingShape& ring : rings)
        for (std::size_t i = 0; i < ring.points.size(); i++)
            if (ring.shape[i] == Shape::Plane && !chosen[ring.points[i]])
                flat.push_back(ring.points[i]);
    const PointIndices more = onePerVoxel(scan, flat, voxel_size);
    planes.insert(planes.end(), more.begin(), more.end());
}

Choice choose(const Scan& scan, const std::vector<RingShape>& rings, const Config& config)
{
    Choice choice;
    for (const RingShape& ring : rings)
    {
        RingChooser chooser(scan, ring, config);
        chooser.choose(Shape::Edge, config.edges_per_sector, choice.edges);
        chooser.choose(Shape::Plane, config.planes_per_sector, choice.planes);
    }
    if (config.flat_voxel > 0) addFlatPoints(scan, rings, config.flat_voxel, choice.planes);
    return choice;
}

/** Edges are few and keep their place, up to half of what is allowed. */
void limit(const Scan& scan, std::size_t max_points, double voxel_size, Choice& choice)
{
    if (choice.size() <= max_points) return;
    const std::size_t least = max_points / 2;
    const std::size_t room =
        max_points > choice.planes.size() ? max_points - choice.planes.size() : 0;
    choice.edges = thinToAtMost(scan, std::move(choice.edges), voxel_size, std::max(least, room));
    choice.planes =
        thinToAtMost(scan, std::move(choice.planes), voxel_size, max_points - choice.edges.size());
}

std::vector<RingShape> shapesOf(const Scan& scan, const PointIndices& points, const Config& config)
{
    std::vector<PointIndices> rings = sortedRings(scan, points);
    const double step = angularStep(scan, rings);
    std::vector<RingShape> shapes;
    shapes.reserve(rings.size());
    for (PointIndices& ring : rings)
        shapes.push_back(shapeOfRing(scan, std::move(ring), step, config));
    return shapes;
}

Features featuresOf(const Scan& scan, const Choice& choice)
{
    Features features;
    features.stamp = scan.stamp;
    for (const std::uint32_t i : choice.edges) addFeature(scan, i, FeatureKind::Edge, features);
    for (const std::uint32_t i : choice.planes) addFeature(scan, i, FeatureKind::Plane, features);
    return features;
}

/** Adds the points not chosen, up to `max_points` in all. */
void addOtherPoints(
    const Scan& scan, const PointIndices& all, const Choice& choice, double voxel_size,
    std::size_t max_points, Features& features)
{
    std::vector<bool> chosen(scan.points.size(), false);
    for (const auto* indices : {&choice.edges, &choice.planes})
        for (const std::uint32_t i : *indices) chosen[i] = true;
    PointIndices others;
    for (const std::uint32_t i : all)
        if (!chosen[i]) others.push_back(i);
    for (const std::uint32_t i :
         thinToAtMost(scan, std::move(others), voxel_size, max_points - choice.size()))
        addFeature(scan, i, FeatureKind::Any, features);
}
}  // namespace

void CurvatureExtractor::configure(ConfigSection& section)
{
    Config& c = config_;
    section.key("neighbours", c.neighbours, {1, 100}, "on either side of a point");
    section.key(
        "neighbour_spacing", c.neighbour_spacing, kNotNegative, "m, least between neighbours");
    section.key("range_noise", c.range_noise, kNotNegative, "m, standard deviation");
    section.key("edge_curvature", c.edge_curvature, kPositive, "tan(turn / 2); an edge has more");
    section.key("plane_curvature", c.plane_curvature, kPositive, "a plane has less");
    section.key("occlusion_step", c.occlusion_step, kPositive, "m, step in range that hides");
    section.key("max_incidence", c.max_incidence, {1, 89.9}, "deg, between beam and normal");
    section.key("sectors", c.sectors, {1, 1000}, "of a ring");
    section.key("edges_per_sector", c.edges_per_sector, {0, 1e6}, "at most");
    section.key("planes_per_sector", c.planes_per_sector, {0, 1e6}, "at most");
    section.key("feature_distance", c.feature_distance, kNotNegative, "m, between features");
    section.key(
        "flat_voxel", c.flat_voxel, kNotNegative, "m, one more flat point in each; 0 for none");
    section.key("min_points", c.min_points, kNotNegative, "fewer features: thin less");
    section.key("max_points", c.max_points, {1, 1e9}, "more features: thin more");
    if (c.min_points > c.max_points)
        throw ConfigError(section.path() + ": min_points exceeds max_points");
    if (c.plane_curvature > c.edge_curvature)
        throw ConfigError(section.path() + ": plane_curvature exceeds edge_curvature");
}

Features CurvatureExtractor::extract(const Scan& scan, const WarningSink& warn) const
{
    if (scan.rings <= 0)
        throw std::runtime_error(
            "CurvatureExtractor needs a LiDAR with rings, and the scans of '" + scan.sensor_label +
            "' have none: use VoxelThinning");
    const PointIndices all = finitePoints(scan);
    const auto min_points = static_cast<std::size_t>(config_.min_points);
    const auto max_points = static_cast<std::size_t>(config_.max_points);
    const bool sparse = warnIfSparse(scan, all.size(), min_points, warn);

    const std::vector<RingShape> rings = shapesOf(scan, all, config_);
    Config relaxed = config_;
    Choice choice = choose(scan, rings, relaxed);
    const std::size_t at_first = choice.size();
    for (int i = 0; i < kRelaxations && choice.size() < min_points; i++)
    {
        relaxed.edges_per_sector *= 2;
        relaxed.planes_per_sector *= 2;
        relaxed.feature_distance /= 2;
        relaxed.flat_voxel /= 2;
        choice = choose(scan, rings, relaxed);
    }
    if (at_first < min_points && !sparse && warn)
        warn(
            {scan.end, "few_features",
             std::to_string(at_first) + " features, fewer than " + std::to_string(min_points) +
                 ": thinned less, " + std::to_string(choice.size()) + " now"});

    const double voxel_size = std::max(relaxed.flat_voxel, kSmallestVoxel);
    limit(scan, max_points, voxel_size, choice);
    Features features = featuresOf(scan, choice);
    if (choice.size() < min_points)
        addOtherPoints(scan, all, choice, voxel_size, max_points, features);
    sortFeatures(features);
    return features;
}
}  // namespace taut
