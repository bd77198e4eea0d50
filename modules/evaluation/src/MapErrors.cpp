#include <algorithm>
#include <limits>

#include "taut/evaluation/MapScores.h"
#include "taut/evaluation/PointGrid.h"

namespace taut
{
namespace
{
constexpr std::size_t kChunk = 4096;
constexpr std::size_t kSamples = 400'000;  // of the truth: a share to 0.08 % (standard deviation)
constexpr double kCellsIn = 2;             // cells of a cloud's samples within `within`

std::vector<double> distances(
    const std::vector<Eigen::Vector3f>& map, const TrueSurface& truth, const Pose& T_truth_map,
    Executor& executor)
{
    std::vector<double> out(map.size());
    executor.forChunks(
        map.size(), kChunk,
        [&](std::size_t, std::size_t begin, std::size_t end)
        {
            std::uint32_t guess = TrueSurface::Nearest::kNone;
            for (std::size_t i = begin; i < end; i++)
            {
                const TrueSurface::Nearest nearest = truth.nearest(
                    T_truth_map * map[i].cast<double>(), std::numeric_limits<double>::infinity(),
                    guess);
                out[i] = nearest.distance;
                guess = nearest.element;
            }
        });
    return out;
}
}  // namespace

MapErrors scoreMap(
    const std::vector<Eigen::Vector3f>& map, const TrueSurface& truth,
    const MapErrorOptions& options, Executor& executor)
{
    MapErrors errors;
    errors.within = options.within;
    const PointGrid grid(map, options.within);  // neighbours follow on each other in it
    std::vector<double> values = distances(grid.points(), truth, options.T_truth_map, executor);
    values.erase(
        std::remove_if(values.begin(), values.end(), [&](double d) { return d > options.reach; }),
        values.end());
    errors.left_out = map.size() - values.size();
    const auto near =
        std::count_if(values.begin(), values.end(), [&](double d) { return d <= options.within; });
    if (!values.empty())
        errors.near_share = static_cast<double>(near) / static_cast<double>(values.size());
    errors.percentile95 = quantileOf(values, 0.95);
    errors.distance = statisticsOf(std::move(values));

    const std::vector<Vector3d> samples = truth.samples(kSamples, options.within / kCellsIn);
    const Pose T_map_truth = options.T_truth_map.inverse();
    std::vector<std::size_t> covered(Executor::chunks(samples.size(), kChunk));
    executor.forChunks(
        samples.size(), kChunk,
        [&](std::size_t chunk, std::size_t begin, std::size_t end)
        {
            for (std::size_t i = begin; i < end; i++)
                if (grid.hasWithin(T_map_truth * samples[i], options.within)) covered[chunk]++;
        });
    std::size_t all = 0;
    for (const std::size_t n : covered) all += n;
    errors.samples = samples.size();
    errors.completeness = static_cast<double>(all) / static_cast<double>(samples.size());
    return errors;
}
}  // namespace taut
