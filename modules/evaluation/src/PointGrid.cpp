#include "taut/evaluation/PointGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace taut
{
namespace
{
constexpr std::int64_t kMost = (1 << 20) - 2;  // cells to each side; 21 bits hold them
}  // namespace

PointGrid::Cell PointGrid::cellOf(const Eigen::Vector3d& p) const
{
    Cell cell{};
    // What is further away shares the outermost cells: slower, not wrong.
    for (int i = 0; i < 3; i++)
        cell[i] = static_cast<std::int64_t>(std::clamp(
            std::floor(p[i] / size_), -static_cast<double>(kMost), static_cast<double>(kMost)));
    return cell;
}

std::uint64_t PointGrid::keyOf(const Cell& cell)
{
    std::uint64_t key = 0;
    for (const std::int64_t i : cell) key = key << 21 | static_cast<std::uint64_t>(i + kMost + 1);
    return key;
}

PointGrid::PointGrid(const std::vector<Eigen::Vector3f>& points, double cell) : size_(cell)
{
    if (!(cell > 0)) throw std::invalid_argument("cells without size");
    if (points.size() > std::numeric_limits<std::uint32_t>::max())
        throw std::invalid_argument("too many points for a grid");
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(points.size());
    for (std::size_t i = 0; i < points.size(); i++)
        order[i] = {keyOf(cellOf(points[i].cast<double>())), static_cast<std::uint32_t>(i)};
    std::sort(order.begin(), order.end());
    points_.reserve(points.size());
    for (const auto& [key, index] : order)
    {
        if (keys_.empty() || keys_.back() != key)
        {
            keys_.push_back(key);
            begins_.push_back(static_cast<std::uint32_t>(points_.size()));
        }
        points_.push_back(points[index]);
    }
    begins_.push_back(static_cast<std::uint32_t>(points_.size()));
}

PointGrid::Ranges PointGrid::around(const Eigen::Vector3d& p) const
{
    const Cell c = cellOf(p);
    Ranges ranges{};
    std::size_t n = 0;
    for (int x = -1; x <= 1; x++)
        for (int y = -1; y <= 1; y++)
        {
            // The three cells above each other follow on each other.
            const auto first =
                std::lower_bound(keys_.begin(), keys_.end(), keyOf({c[0] + x, c[1] + y, c[2] - 1}));
            const std::uint64_t last = keyOf({c[0] + x, c[1] + y, c[2] + 1});
            auto end = first;
            while (end != keys_.end() && *end <= last) ++end;
            ranges[n++] = {begins_[first - keys_.begin()], begins_[end - keys_.begin()]};
        }
    return ranges;
}

bool PointGrid::hasWithin(const Eigen::Vector3d& p, double radius) const
{
    for (const auto& [begin, end] : around(p))
        for (std::size_t i = begin; i < end; i++)
            if ((points_[i].cast<double>() - p).squaredNorm() <= radius * radius) return true;
    return false;
}
}  // namespace taut
