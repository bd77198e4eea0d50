#include "taut/completion/RingFinder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>

#include "taut/core/format.h"

namespace taut
{
namespace
{
constexpr double kDegree = M_PI / 180;
constexpr std::size_t kFewestBeams = 4, kMostBeams = 256;
constexpr double kFewestTurns = 3.5;  // of the azimuth in a sweep that has its lasers in order
constexpr double kSteepest = 70 * kDegree;    // no turning LiDAR looks higher or lower
constexpr double kShareOnCones = 0.98;        // of the points: as many must be near a cone
constexpr double kNear = 0.25;                // of the distance between two cones
constexpr double kAgreeing = 0.5;             // of the sweeps: as many must have the same lasers
constexpr double kSeamStep = 0.25 * kDegree;  // between two guesses where turns begin
constexpr std::size_t kFewestPoints = 30;     // of a laser in a sweep
constexpr double kLeastDistance = 0.3;        // [m] across; nearer points tell nothing

/** One point: `tangent` = slope + height * inverse on the cone of its laser. */
struct Place
{
    double inverse;  // of the horizontal distance [1/m]
    double tangent;  // of the elevation above the sensor's origin
};

std::optional<Place> placeOf(const LidarPoint& point)
{
    const double across = std::hypot(point.position.x(), point.position.y());
    if (!(across > kLeastDistance)) return {};
    return Place{1 / across, point.position.z() / across};
}

double median(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/** Sums for fitting a line to places. */
struct Sums
{
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

    void add(const Place& p)
    {
        n++;
        x += p.inverse;
        y += p.tangent;
        xx += p.inverse * p.inverse;
        xy += p.inverse * p.tangent;
        yy += p.tangent * p.tangent;
    }
    Sums operator-(const Sums& o) const
    {
        return {n - o.n, x - o.x, y - o.y, xx - o.xx, xy - o.xy, yy - o.yy};
    }
    BeamCone line() const
    {
        const double spread = n * xx - x * x;
        const double height = spread > 1e-9 * n * xx ? (n * xy - x * y) / spread : 0;
        return {(y - height * x) / n, height};
    }
    /** Sum of the squares of what the line leaves. */
    double rest() const
    {
        const BeamCone c = line();
        return std::max(0.0, yy - c.slope * y - c.height * xy);
    }
};

double offCone(const BeamCone& cone, const Place& p)
{
    return std::abs(cone.slope + cone.height * p.inverse - p.tangent);
}

/** The line through most of the places: those that are far from it do not count. */
BeamCone fit(const std::vector<Place>& places, std::size_t begin, std::size_t end)
{
    constexpr int kRounds = 3;
    constexpr double kFar = 6;      // medians
    constexpr double kFine = 1e-4;  // of a tangent: what is never far
    Sums all;
    for (std::size_t i = begin; i < end; i++) all.add(places[i]);
    BeamCone cone = all.line();
    for (int round = 0; round < kRounds; round++)
    {
        std::vector<double> distances;
        for (std::size_t i = begin; i < end; i++) distances.push_back(offCone(cone, places[i]));
        const double limit = kFar * median(distances) + kFine;
        Sums near;
        for (std::size_t i = begin; i < end; i++)
            if (distances[i - begin] <= limit) near.add(places[i]);
        cone = near.line();
    }
    return cone;
}

/** A sweep as a walk through its points: how far the azimuth has turned at each. */
struct Walk
{
    std::vector<Place> places;
    std::vector<double> turned;  // [rad] never decreasing; from the azimuth of the first point
    double first = 0;            // [rad] azimuth of the first point, in the sense of the walk
};

Walk walkThrough(const Scan& scan)
{
    Walk walk;
    std::vector<double> azimuths;
    double total = 0;
    for (const LidarPoint& point : scan.points)
        if (const auto place = placeOf(point))
        {
            walk.places.push_back(*place);
            azimuths.push_back(std::atan2(point.position.y(), point.position.x()));
            if (azimuths.size() > 1)
                total += std::remainder(azimuths.back() - azimuths[azimuths.size() - 2], 2 * M_PI);
        }
    if (azimuths.empty()) return walk;
    const double sense = total < 0 ? -1 : 1;
    walk.first = sense * azimuths.front();
    double turned = 0, most = 0;
    for (std::size_t i = 0; i < azimuths.size(); i++)
    {
        if (i > 0) turned += sense * std::remainder(azimuths[i] - azimuths[i - 1], 2 * M_PI);
        most = std::max(most, turned);
        walk.turned.push_back(most);
    }
    return walk;
}

/** Where the turns of a walk end, if one begins wherever the azimuth passes `seam`. */
std::vector<std::size_t> turnEnds(const Walk& walk, double seam)
{
    double next = std::remainder(seam - walk.first, 2 * M_PI);
    if (next <= 0) next += 2 * M_PI;
    std::vector<std::size_t> ends;
    for (; next <= walk.turned.back(); next += 2 * M_PI)
        ends.push_back(static_cast<std::size_t>(
            std::lower_bound(walk.turned.begin(), walk.turned.end(), next) - walk.turned.begin()));
    ends.push_back(walk.turned.size());
    return ends;
}

/** What lines through each turn leave. */
double restOf(const std::vector<Sums>& sums, const std::vector<std::size_t>& ends)
{
    double rest = 0;
    std::size_t begin = 0;
    for (const std::size_t end : ends)
    {
        if (end > begin) rest += (sums[end] - sums[begin]).rest();
        begin = end;
    }
    return rest;
}

/** The azimuth at which a turn ends, and the next laser's begins. */
double seamOf(const Walk& walk)
{
    std::vector<Sums> sums(walk.places.size() + 1);
    for (std::size_t i = 0; i < walk.places.size(); i++)
    {
        sums[i + 1] = sums[i];
        sums[i + 1].add(walk.places[i]);
    }
    double best = 0, least = std::numeric_limits<double>::max();
    for (double seam = -M_PI; seam < M_PI; seam += kSeamStep)
    {
        const double rest = restOf(sums, turnEnds(walk, seam));
        if (rest >= least) continue;
        least = rest;
        best = seam;
    }
    return best;
}

bool isHigher(const BeamCone& a, const BeamCone& b)
{
    return a.slope > b.slope;
}

/** Where a sweep holds one laser after the other. */
std::vector<BeamCone> beamsByOrder(const Scan& scan)
{
    const Walk walk = walkThrough(scan);
    if (walk.places.empty() || walk.turned.back() < kFewestTurns * 2 * M_PI) return {};
    std::vector<BeamCone> beams;
    std::size_t begin = 0;
    for (const std::size_t end : turnEnds(walk, seamOf(walk)))
    {
        if (end >= begin + kFewestPoints) beams.push_back(fit(walk.places, begin, end));
        begin = end;
    }
    std::sort(beams.begin(), beams.end(), isHigher);
    return beams;
}

/** By the elevations that many points have. */
std::vector<BeamCone> beamsByElevation(const std::vector<const Scan*>& scans)
{
    constexpr double kBin = 0.02 * kDegree;
    constexpr double kLeast = 0.05;    // of the mean of all bins from the first to the last
    constexpr double kLightest = 0.1;  // of the median beam: lighter ones are stray points
    constexpr int kGap = 2;            // bins that part two elevations
    std::map<int, std::vector<double>> bins;
    std::size_t count = 0;
    for (const Scan* scan : scans)
        for (const LidarPoint& point : scan->points)
            if (const auto place = placeOf(point))
            {
                bins[static_cast<int>(std::lround(std::atan(place->tangent) / kBin))].push_back(
                    place->tangent);
                count++;
            }
    if (bins.empty()) return {};
    const int span = bins.rbegin()->first - bins.begin()->first + 1;
    const double least = kLeast * static_cast<double>(count) / span;
    std::vector<std::vector<double>> groups;
    int last = std::numeric_limits<int>::min() / 2;
    for (auto& [bin, tangents] : bins)
    {
        if (static_cast<double>(tangents.size()) < least) continue;
        if (bin - last > kGap) groups.emplace_back();
        groups.back().insert(groups.back().end(), tangents.begin(), tangents.end());
        last = bin;
    }
    if (groups.size() < kFewestBeams) return {};
    std::vector<double> sizes;
    for (const auto& group : groups) sizes.push_back(static_cast<double>(group.size()));
    const double usual = median(std::move(sizes));
    std::vector<BeamCone> beams;
    for (auto& group : groups)
        if (static_cast<double>(group.size()) >= kLightest * usual)
            beams.push_back({median(std::move(group)), 0});
    std::sort(beams.begin(), beams.end(), isHigher);
    return beams;
}

/** Among as many beams as most sweeps have, the median of each. Empty if too few sweeps agree. */
std::vector<BeamCone> agreedOn(const std::vector<std::vector<BeamCone>>& of_sweeps)
{
    std::map<std::size_t, std::size_t> counts;
    for (const auto& beams : of_sweeps) counts[beams.size()]++;
    const auto most = std::max_element(
        counts.begin(), counts.end(),
        [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == counts.end() ||
        static_cast<double>(most->second) < kAgreeing * static_cast<double>(of_sweeps.size()))
        return {};
    std::vector<BeamCone> agreed;
    for (std::size_t i = 0; i < most->first; i++)
    {
        std::vector<double> slopes, heights;
        for (const auto& beams : of_sweeps)
            if (beams.size() == most->first)
            {
                slopes.push_back(beams[i].slope);
                heights.push_back(beams[i].height);
            }
        agreed.push_back({median(std::move(slopes)), median(std::move(heights))});
    }
    return agreed;
}
}  // namespace

bool RingFinder::learn(const std::vector<const Scan*>& scans)
{
    beams_.clear();
    std::vector<std::vector<BeamCone>> by_order;
    for (const Scan* scan : scans) by_order.push_back(beamsByOrder(*scan));
    return accept(std::move(by_order), scans, "the order of the points") ||
           accept({beamsByElevation(scans)}, scans, "the elevations of the points");
}

bool RingFinder::accept(
    std::vector<std::vector<BeamCone>> of_sweeps, const std::vector<const Scan*>& scans,
    const std::string& how)
{
    beams_ = agreedOn(of_sweeps);
    const auto refuse = [this](const std::string& why)
    {
        beams_.clear();
        finding_ = "rings: none (" + why + ")";
        return false;
    };
    if (beams_.size() < kFewestBeams || beams_.size() > kMostBeams)
        return refuse("neither order nor elevations tell the lasers apart");
    if (std::atan(beams_.front().slope) > kSteepest || std::atan(beams_.back().slope) < -kSteepest)
        return refuse("the elevations are those of no turning LiDAR");
    std::size_t seen = 0, on_cone = 0;
    std::vector<std::size_t> of_beam(beams_.size());
    for (const Scan* scan : scans)
        for (const LidarPoint& point : scan->points)
        {
            const auto place = placeOf(point);
            if (!place) continue;
            double distance = 0;
            const std::size_t ring = nearest(point, &distance);
            // To the next cone, where this point is.
            double between = std::numeric_limits<double>::max();
            for (const std::size_t other : {ring - 1, ring + 1})
                if (other < beams_.size())
                    between = std::min(between, offCone(beams_[other], *place));
            seen++;
            if (distance > kNear * between) continue;
            on_cone++;
            of_beam[ring]++;
        }
    if (static_cast<double>(on_cone) < kShareOnCones * static_cast<double>(seen))
        return refuse(
            "only " +
            format(
                "%.0f", 100.0 * static_cast<double>(on_cone) /
                            static_cast<double>(std::max<std::size_t>(seen, 1))) +
            " % of the points fit " + std::to_string(beams_.size()) + " lasers");
    if (*std::min_element(of_beam.begin(), of_beam.end()) == 0)
        return refuse("two lasers would have the same elevation");
    finding_ = "rings: " + std::to_string(beams_.size()) + ", told from " + how +
               format(
                   "; elevations from %.2f to %.2f deg", std::atan(beams_.front().slope) / kDegree,
                   std::atan(beams_.back().slope) / kDegree);
    return true;
}

std::size_t RingFinder::nearest(const LidarPoint& point, double* distance) const
{
    const auto place = placeOf(point);
    const Place p =
        place
            ? *place
            : Place{
                  0, point.position.z() / std::max(
                                              1e-6, std::hypot(
                                                        static_cast<double>(point.position.x()),
                                                        static_cast<double>(point.position.y())))};
    std::size_t best = 0;
    double least = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < beams_.size(); i++)
    {
        const double off = offCone(beams_[i], p);
        if (off >= least) continue;
        least = off;
        best = i;
    }
    if (distance != nullptr) *distance = least;
    return best;
}

void RingFinder::apply(Scan& scan) const
{
    if (beams_.empty()) return;
    scan.rings = static_cast<int>(beams_.size());
    for (LidarPoint& point : scan.points) point.ring = static_cast<std::uint16_t>(nearest(point));
}
}  // namespace taut
