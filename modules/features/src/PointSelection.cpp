#include "PointSelection.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>
#include <utility>
#include <vector>

#include "taut/core/Voxel.h"

namespace taut
{
namespace
{
/** A number as good as random that belongs to the point, wherever it stands in the scan. */
std::uint64_t lotOf(const LidarPoint& point)
{
    std::uint32_t bits[3];
    std::memcpy(bits, point.position.data(), sizeof(bits));
    const auto time = static_cast<std::uint32_t>(point.offset);
    const auto first = static_cast<std::uint64_t>(bits[0]) << 32 | bits[1];
    const auto second = static_cast<std::uint64_t>(bits[2]) << 32 | time;
    return mixBits(first ^ mixBits(second + 0x9e3779b97f4a7c15u));
}

/** The point drawn of each voxel. A table of its own, small enough for the cache: this is the loop
 * of an extraction that takes the time. */
class Draw
{
 public:
    explicit Draw(std::size_t most_voxels)
        : bits_(bitsAbove(2 * most_voxels)), table_(std::size_t{1} << bits_, kEmpty)
    {
        drawn_.reserve(most_voxels);
    }

    /** Of the points of a voxel the one of the smallest priority is kept. */
    void add(std::uint64_t voxel, std::uint64_t priority, std::uint32_t point)
    {
        std::size_t at = placeOf(voxel);
        while (table_[at] != kEmpty && drawn_[table_[at]].voxel != voxel)
            at = (at + 1) & (table_.size() - 1);
        if (table_[at] == kEmpty)
        {
            table_[at] = static_cast<std::uint32_t>(drawn_.size());
            drawn_.push_back({voxel, priority, point});
            return;
        }
        Drawn& drawn = drawn_[table_[at]];
        if (priority >= drawn.priority) return;
        drawn.priority = priority;
        drawn.point = point;
    }

    PointIndices points() const
    {
        PointIndices all;
        all.reserve(drawn_.size());
        for (const Drawn& d : drawn_) all.push_back(d.point);
        return all;
    }

 private:
    struct Drawn
    {
        std::uint64_t voxel, priority;
        std::uint32_t point;
    };
    static constexpr std::uint32_t kEmpty = 0xffffffff;

    static int bitsAbove(std::size_t n)
    {
        int bits = 1;
        while (n >> bits != 0) bits++;
        return bits;
    }
    /** The high bits of the product depend on all of the key. */
    std::size_t placeOf(std::uint64_t voxel) const
    {
        return voxel * 0x9e3779b97f4a7c15u >> (64 - bits_);
    }

    int bits_;                          // of a place in the table
    std::vector<std::uint32_t> table_;  // places in drawn_, by hash
    std::vector<Drawn> drawn_;
};
}  // namespace

PointIndices finitePoints(const Scan& scan)
{
    PointIndices indices;
    indices.reserve(scan.points.size());
    for (std::uint32_t i = 0; i < scan.points.size(); i++)
        if (scan.points[i].position.allFinite()) indices.push_back(i);
    return indices;
}

PointIndices onePerVoxel(const Scan& scan, const PointIndices& candidates, double voxel_size)
{
    const float inverse = static_cast<float>(1 / voxel_size);
    // What is known of a point before it meets the others is computed ahead: a processor that
    // guesses wrongly in the table throws away what it began beyond.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> voxels_and_lots;
    voxels_and_lots.reserve(candidates.size());
    for (const std::uint32_t i : candidates)
    {
        const LidarPoint& point = scan.points[i];
        voxels_and_lots.emplace_back(voxelKey(point.position, inverse), lotOf(point));
    }
    Draw draw(candidates.size());
    for (std::size_t i = 0; i < candidates.size(); i++)
        draw.add(voxels_and_lots[i].first, voxels_and_lots[i].second, candidates[i]);
    return draw.points();
}

PointIndices thinToAtMost(
    const Scan& scan, PointIndices candidates, double voxel_size, std::size_t max_points)
{
    if (max_points == 0) return {};
    while (candidates.size() > max_points)
    {
        // Points on surfaces become fewer with the square of the voxel's size.
        const double excess =
            static_cast<double>(candidates.size()) / static_cast<double>(max_points);
        voxel_size *= std::max(1.1, std::sqrt(excess));
        candidates = onePerVoxel(scan, candidates, voxel_size);
    }
    return candidates;
}

void addFeature(const Scan& scan, std::uint32_t index, FeatureKind kind, Features& features)
{
    const LidarPoint& point = scan.points[index];
    features.points.push_back({point.position, point.offset, kind});
}

void sortFeatures(Features& features)
{
    const auto key = [](const Feature& f)
    { return std::make_tuple(f.offset, f.kind, f.position.x(), f.position.y(), f.position.z()); };
    std::sort(
        features.points.begin(), features.points.end(),
        [&](const Feature& a, const Feature& b) { return key(a) < key(b); });
}

bool warnIfSparse(
    const Scan& scan, std::size_t points, std::size_t min_points, const WarningSink& warn)
{
    if (points > 0 && points >= min_points) return false;
    if (warn)
        warn(
            {scan.end, "sparse_scan",
             "the scan has " + std::to_string(points) + " points, fewer than " +
                 std::to_string(std::max<std::size_t>(min_points, 1))});
    return true;
}
}  // namespace taut
