#include "Rings.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace taut
{
namespace
{
/** Place of a point on its ring. */
struct Place
{
    std::int32_t offset;
    float turn;  // grows with the azimuth, 4 a turn; cheaper than atan2
    float range2;
    std::uint32_t index;
};

Place placeOf(const Scan& scan, std::uint32_t index)
{
    const LidarPoint& point = scan.points[index];
    const float x = point.position.x(), y = point.position.y();
    const float sum = std::abs(x) + std::abs(y);
    const float slope = sum > 0 ? y / sum : 0;
    const float turn = x >= 0 ? slope : (y >= 0 ? 2 - slope : -2 - slope);
    return {point.offset, turn, point.position.squaredNorm(), index};
}

void sortPlaces(std::vector<Place>& places)
{
    const auto before = [](const Place& a, const Place& b)
    { return std::tie(a.offset, a.turn, a.range2) < std::tie(b.offset, b.turn, b.range2); };
    if (!std::is_sorted(places.begin(), places.end(), before))
        std::sort(places.begin(), places.end(), before);
}

/** Does the azimuth fall with time? Only points of different times tell. */
bool turnsClockwise(const std::vector<Place>& places)
{
    double sum = 0;
    for (std::size_t i = 1, last = 0; i < places.size(); i++)
        if (places[i].offset != places[last].offset)
        {
            const double change = places[i].turn - places[last].turn;
            sum += change - 4 * std::round(change / 4);
            last = i;
        }
    return sum < 0;
}
}  // namespace

std::vector<PointIndices> sortedRings(const Scan& scan, const PointIndices& candidates)
{
    std::vector<std::vector<Place>> places(static_cast<std::size_t>(scan.rings));
    for (auto& ring : places) ring.reserve(candidates.size() / places.size());
    for (const std::uint32_t i : candidates)
    {
        const std::uint16_t ring = scan.points[i].ring;
        if (ring >= places.size())
            throw std::runtime_error(
                "a point on ring " + std::to_string(ring) + " of a scan with " +
                std::to_string(scan.rings) + " rings");
        places[ring].push_back(placeOf(scan, i));
    }

    std::vector<PointIndices> rings(places.size());
    for (std::size_t r = 0; r < places.size(); r++)
    {
        sortPlaces(places[r]);
        if (turnsClockwise(places[r]))
        {
            for (Place& place : places[r]) place.turn = -place.turn;
            sortPlaces(places[r]);
        }
        rings[r].reserve(places[r].size());
        for (const Place& place : places[r]) rings[r].push_back(place.index);
    }
    return rings;
}

double angleBetween(const LidarPoint& a, const LidarPoint& b)
{
    const double lengths = a.position.norm() * b.position.norm();
    return lengths > 0 ? a.position.cross(b.position).norm() / lengths : 0;
}

double angularStep(const Scan& scan, const std::vector<PointIndices>& rings)
{
    constexpr std::size_t kSteps = 8;  // at a time: in packets, short and long ones alternate
    std::vector<double> angles;
    for (const PointIndices& ring : rings)
        for (std::size_t i = kSteps; i < ring.size(); i += kSteps)
            angles.push_back(angleBetween(scan.points[ring[i - kSteps]], scan.points[ring[i]]));
    if (angles.empty()) return 0;
    const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
    std::nth_element(angles.begin(), middle, angles.end());
    return *middle / kSteps;
}
}  // namespace taut
