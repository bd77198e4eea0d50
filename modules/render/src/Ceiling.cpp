#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <unordered_map>

#include "taut/render/PointCloud.h"

namespace taut
{
namespace
{
constexpr float kHeadroom = 0.3F;     // [m] points from this far below the body on block a column
constexpr float kClearance = 0.3F;    // [m] least height of a ceiling over the body
constexpr float kThickness = 0.5F;    // [m] of a ceiling, at most
constexpr int kLeastPoints = 3;       // of a column, to tell
constexpr double kRoofedShare = 0.2;  // of the columns, to be indoors
constexpr int kCells = 128;           // at most, along an axis, for the body's height
constexpr float kUnknown = std::numeric_limits<float>::infinity();

/** Height of the body over the ground plan: that of the highest pose in a cell, else of the nearest
 * cell with poses. */
class BodyHeight
{
 public:
    explicit BodyHeight(const std::vector<Pose>& trajectory)
    {
        low_ = high_ = trajectory.front().p.head<2>();
        for (const Pose& pose : trajectory)
        {
            low_ = low_.cwiseMin(pose.p.head<2>());
            high_ = high_.cwiseMax(pose.p.head<2>());
        }
        cell_size_ = std::max(0.5, (high_ - low_).maxCoeff() / (kCells - 1));
        columns_ = cellOf(high_.x(), low_.x()) + 1;
        rows_ = cellOf(high_.y(), low_.y()) + 1;
        height_.assign(static_cast<std::size_t>(columns_ * rows_), kUnknown);
        for (const Pose& pose : trajectory)
        {
            float& h = height_[indexOf(pose.p.x(), pose.p.y())];
            const auto z = static_cast<float>(pose.p.z());
            h = h == kUnknown ? z : std::max(h, z);
        }
        spread();
    }

    Span range() const
    {
        const auto [low, high] = std::minmax_element(height_.begin(), height_.end());
        return {static_cast<double>(*low), static_cast<double>(*high)};
    }

    /** The same height everywhere. */
    void level(float height) { std::fill(height_.begin(), height_.end(), height); }

    float at(const Eigen::Vector3f& point) const
    {
        return height_[indexOf(static_cast<double>(point.x()), static_cast<double>(point.y()))];
    }

 private:
    int cellOf(double value, double low) const
    {
        return static_cast<int>(std::clamp((value - low) / cell_size_, 0.0, kCells - 1.0));
    }

    std::size_t indexOf(double x, double y) const
    {
        const int column = std::min(cellOf(x, low_.x()), columns_ - 1);
        const int row = std::min(cellOf(y, low_.y()), rows_ - 1);
        return static_cast<std::size_t>(row * columns_ + column);
    }

    /** Breadth first from the known cells: each unknown one takes the height of the nearest. */
    void spread()
    {
        std::deque<int> front;
        for (int i = 0; i < columns_ * rows_; ++i)
            if (height_[static_cast<std::size_t>(i)] != kUnknown) front.push_back(i);
        while (!front.empty())
        {
            const int i = front.front();
            front.pop_front();
            const int column = i % columns_, row = i / columns_;
            const auto visit = [&](int c, int r)
            {
                if (c < 0 || r < 0 || c >= columns_ || r >= rows_) return;
                float& h = height_[static_cast<std::size_t>(r * columns_ + c)];
                if (h != kUnknown) return;
                h = height_[static_cast<std::size_t>(i)];
                front.push_back(r * columns_ + c);
            };
            visit(column - 1, row);
            visit(column + 1, row);
            visit(column, row - 1);
            visit(column, row + 1);
        }
    }

    Eigen::Vector2d low_, high_;
    double cell_size_ = 1;
    int columns_ = 1, rows_ = 1;
    std::vector<float> height_;
};

/** What lies over a square of the ground plan from just below the body's height on, relative to it.
 */
struct Column
{
    float lowest = std::numeric_limits<float>::infinity();
    float highest = -std::numeric_limits<float>::infinity();
    int points = 0;

    /** A ceiling is flat and hangs over nothing that is as high as the body. */
    bool roofed() const
    {
        return points >= kLeastPoints && lowest > kClearance && highest - lowest < kThickness;
    }
};

std::vector<Column> columnsOf(const PointCloud& points, const BodyHeight& body)
{
    constexpr float kColumnsPerMetre = 2;
    std::unordered_map<std::uint64_t, Column> columns;
    for (const auto& point : points)
    {
        const auto cell = [](float v)
        {
            const float c = std::clamp(std::floor(v * kColumnsPerMetre), -1e9F, 1e9F);
            return static_cast<std::uint32_t>(static_cast<std::int32_t>(c));
        };
        Column& column =
            columns[static_cast<std::uint64_t>(cell(point.x())) << 32 | cell(point.y())];
        const float clearance = point.z() - body.at(point);
        if (clearance < -kHeadroom) continue;
        column.lowest = std::min(column.lowest, clearance);
        column.highest = std::max(column.highest, clearance);
        ++column.points;
    }
    std::vector<Column> values;
    values.reserve(columns.size());
    for (const auto& entry : columns) values.push_back(entry.second);
    return values;
}

/** Median clearance over the body of the roofed columns; 0 if they are few. */
float ceilingClearance(const std::vector<Column>& columns)
{
    std::vector<float> roofs;
    for (const Column& column : columns)
        if (column.roofed()) roofs.push_back(column.lowest);
    if (roofs.empty() ||
        static_cast<double>(roofs.size()) < kRoofedShare * static_cast<double>(columns.size()))
        return 0;
    const auto middle = roofs.begin() + static_cast<std::ptrdiff_t>(roofs.size() / 2);
    std::nth_element(roofs.begin(), middle, roofs.end());
    return *middle;
}
}  // namespace

PointCloud withoutCeiling(const PointCloud& points, const std::vector<Pose>& trajectory)
{
    if (points.empty() || trajectory.empty()) return points;
    BodyHeight body(trajectory);
    const float clearance = ceilingClearance(columnsOf(points, body));
    if (clearance <= 0) return points;
    const float kept_above_body = clearance / 2;
    // On one storey the walls end at one height.
    const Span range = body.range();
    if (range.size() < static_cast<double>(kept_above_body))
        body.level(static_cast<float>(range.high));

    PointCloud kept;
    std::copy_if(
        points.begin(), points.end(), std::back_inserter(kept),
        [&](const Eigen::Vector3f& p) { return p.z() <= body.at(p) + kept_above_body; });
    return kept;
}
}  // namespace taut
