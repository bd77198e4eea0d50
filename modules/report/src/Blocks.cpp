#include "Blocks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace taut
{
namespace
{
constexpr double kLargest = 65535;
constexpr double kGoldenRatio = 0.6180339887498949;

std::vector<std::size_t> finite(const std::vector<ReportPoint>& points)
{
    std::vector<std::size_t> ids;
    ids.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); i++)
        if (points[i].position.allFinite()) ids.push_back(i);
    return ids;
}

/** Steps of this size go through all of n things and spread each beginning evenly. */
std::size_t evenStep(std::size_t n)
{
    auto step = static_cast<std::size_t>(kGoldenRatio * static_cast<double>(n));
    while (step > 1 && std::gcd(step, n) != 1) step--;
    return std::max<std::size_t>(step, 1);
}

float brightest(std::vector<float> intensities)
{
    if (intensities.empty()) return 0;
    const auto at = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(intensities.size() - 1));
    std::nth_element(intensities.begin(), intensities.begin() + at, intensities.end());
    const float most = intensities[static_cast<std::size_t>(at)];
    return most > 0 ? most : *std::max_element(intensities.begin(), intensities.end());
}

std::uint16_t quantised(double value, double min, double size)
{
    if (size <= 0) return 0;
    return static_cast<std::uint16_t>(
        std::lround(std::clamp((value - min) / size, 0.0, 1.0) * kLargest));
}

void setBox(const std::vector<ReportPoint>& points, PackedPoints& packed, std::size_t first)
{
    Eigen::Vector3f low = points[first].position, high = low;
    for (const ReportPoint& p : points)
    {
        if (!p.position.allFinite()) continue;
        low = low.cwiseMin(p.position);
        high = high.cwiseMax(p.position);
    }
    packed.min = low.cast<double>();
    packed.size = high.cast<double>() - packed.min;
}
}  // namespace

std::string base64(const std::string& bytes)
{
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve(base64Size(bytes.size()));
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        const std::size_t there = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; k++)
            three = three << 8 | (k < there ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; k++)
            text += k <= there ? kDigits[three >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

PackedPoints pack(const std::vector<ReportPoint>& points, std::size_t max_count)
{
    PackedPoints packed;
    const std::vector<std::size_t> ids = finite(points);
    packed.count = std::min(ids.size(), max_count);
    if (packed.count == 0) return packed;
    setBox(points, packed, ids.front());
    std::vector<float> intensities;
    for (const std::size_t i : ids)
        if (std::isfinite(points[i].intensity)) intensities.push_back(points[i].intensity);
    packed.max_intensity = std::max(0.f, brightest(std::move(intensities)));

    packed.positions.reserve(6 * packed.count);
    const std::size_t step = evenStep(ids.size());
    for (std::size_t k = 0, at = 0; k < packed.count; k++, at = (at + step) % ids.size())
    {
        const ReportPoint& p = points[ids[at]];
        for (int axis = 0; axis < 3; axis++)
            appendBytes(
                packed.positions, quantised(p.position[axis], packed.min[axis], packed.size[axis]));
        if (packed.max_intensity <= 0) continue;
        const float share = std::isfinite(p.intensity) ? p.intensity / packed.max_intensity : 0.f;
        packed.intensities += static_cast<char>(
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.f, 1.f))));
    }
    return packed;
}
}  // namespace taut
