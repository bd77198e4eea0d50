#include "taut/evaluation/MapScores.h"

#include "taut/core/format.h"
#include "taut/files/PlyFile.h"
#include "taut/trajectory/Scores.h"

namespace taut
{
namespace
{
constexpr std::size_t kMostPoints = 50'000'000;  // of a map; some 80 bytes each

std::vector<Eigen::Vector3f> readMap(const std::string& path, std::size_t& not_finite)
{
    const std::size_t size = PlyReader(path).size();
    if (size > kMostPoints)
        throw std::runtime_error(format(
            "'%s' holds %zu points; at most %zu are scored: thin it", path.c_str(), size,
            kMostPoints));
    std::vector<Eigen::Vector3f> points;
    for (const PlyPoint& point : readPlyPoints(path))
        if (point.position.allFinite())
            points.push_back(point.position);
        else
            not_finite++;
    if (points.empty()) throw std::runtime_error("the map '" + path + "' holds no points");
    return points;
}

MapTruthScores scoreAgainstTruth(
    const std::vector<Eigen::Vector3f>& map, const MapOptions& options, Executor& executor)
{
    const TrueSurface surface(readMesh(options.truth));
    MapTruthScores out;
    out.cloud = surface.isCloud();
    out.elements = surface.size();
    out.area = surface.area();
    out.spacing = surface.spacing();
    out.alignment = "none";
    if (options.T_truth_map)
    {
        out.alignment = "trajectory";
        out.T_truth_map = *options.T_truth_map;
    }
    else if (options.alignment != Alignment::None)
    {
        out.alignment = "icp";
        out.surface = alignToSurface(map, surface, options.alignment);
        out.T_truth_map = out.surface->T_truth_map;
        if (!(out.surface->near_share >= options.min_near))
            throw ScoreRefused(format(
                "refused: %.1f %% of the map's points can be laid within 0.5 m of the truth, "
                "%.1f %% are needed: give --truth and --estimate, or --align none",
                100 * out.surface->near_share, 100 * options.min_near));
    }
    out.errors = scoreMap(map, surface, {out.T_truth_map, options.within, options.reach}, executor);
    if (out.errors.distance.count == 0)
        throw ScoreRefused(
            format("refused: no point of the map is within %g m of the truth", options.reach));
    return out;
}
}  // namespace

MapScores scoreMapFile(const MapOptions& options, Executor& executor)
{
    MapScores scores;
    const std::vector<Eigen::Vector3f> map = readMap(options.map, scores.not_finite);
    scores.points = map.size();
    scores.walls = wallThickness(map, executor);
    scores.entropy = meanMapEntropy(map, executor);
    if (!options.truth.empty()) scores.truth = scoreAgainstTruth(map, options, executor);
    return scores;
}
}  // namespace taut
