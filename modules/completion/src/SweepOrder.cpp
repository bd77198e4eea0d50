#include "SweepOrder.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

namespace taut
{
namespace
{
constexpr double kTurn = 2 * M_PI;
constexpr std::size_t kChunks = 64;  // of a turn, by number of points
constexpr std::size_t kFewestPoints = 256;
constexpr double kTogether = 0.8;                        // resultant of the directions in a chunk
constexpr double kInSense = 0.95;                        // of the steps from chunk to chunk
constexpr double kBackstep = 0.02;                       // [rad] that does not count
constexpr double kLeastTravel = 0.5, kMostTravel = 1.6;  // turns of a sweep in time
constexpr double kFewestLasers = 1.9;                    // turns of a sweep laser by laser
constexpr double kSameRing = 0.95;                       // of neighbours, laser by laser

/** Directions [rad] cut into chunks of as many each. */
struct Chunks
{
    std::vector<double> turned;  // [rad] of the mean of each, from that of the first
    std::vector<double> mean;    // [rad]
    double together = 0;         // share of chunks that have one direction
    double in_sense = 0;         // share of steps that go with most
    double sense = 1;

    bool isSteady() const { return together >= kInSense && in_sense >= kInSense; }
    double travel() const
    {
        const auto n = static_cast<double>(turned.size());
        return n > 1 ? std::abs(turned.back()) / kTurn * n / (n - 1) : 0;
    }
};

Chunks chunksOf(const std::vector<double>& azimuths, std::size_t count)
{
    Chunks chunks;
    std::size_t together = 0, forward = 0, backward = 0;
    for (std::size_t c = 0; c < count; c++)
    {
        const std::size_t begin = c * azimuths.size() / count,
                          end = (c + 1) * azimuths.size() / count;
        std::complex<double> sum = 0;
        for (std::size_t i = begin; i < end; i++) sum += std::polar(1.0, azimuths[i]);
        if (std::abs(sum) > kTogether * static_cast<double>(end - begin)) together++;
        const double mean = std::arg(sum);
        const double step = c > 0 ? wrapped(mean - chunks.mean.back()) : 0;
        forward += step > -kBackstep ? 1 : 0;
        backward += step < kBackstep ? 1 : 0;
        chunks.turned.push_back(c > 0 ? chunks.turned.back() + step : 0);
        chunks.mean.push_back(mean);
    }
    chunks.together = static_cast<double>(together) / static_cast<double>(count);
    chunks.in_sense = static_cast<double>(std::max(forward, backward)) / static_cast<double>(count);
    chunks.sense = chunks.turned.back() < 0 ? -1 : 1;
    return chunks;
}

/** The direction of the first points. */
double firstDirection(const std::vector<double>& azimuths)
{
    const std::size_t n = std::clamp<std::size_t>(azimuths.size() / 500, 8, 64);
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < n; i++) sum += std::polar(1.0, azimuths[i]);
    return std::arg(sum);
}

std::optional<SweepOrder> inTime(const std::vector<double>& azimuths)
{
    const Chunks chunks = chunksOf(azimuths, kChunks);
    if (!chunks.isSteady() || chunks.travel() < kLeastTravel || chunks.travel() > kMostTravel)
        return {};
    SweepOrder order{PointOrder::InTime, chunks.sense, firstDirection(azimuths), {}};
    const double before = wrapped(chunks.mean[0] - order.first);
    order.turned.reserve(azimuths.size());
    for (std::size_t c = 0; c < kChunks; c++)
        for (std::size_t i = c * azimuths.size() / kChunks; i < (c + 1) * azimuths.size() / kChunks;
             i++)
            order.turned.push_back(
                order.sense * (before + chunks.turned[c] + wrapped(azimuths[i] - chunks.mean[c])));
    return order;
}

/** The points of one laser that come one after the other. */
struct Run
{
    std::size_t begin, end;
};

std::vector<Run> runsOf(const Scan& scan)
{
    std::vector<Run> runs;
    for (std::size_t i = 0; i < scan.points.size(); i++)
        if (i > 0 && scan.points[i].ring == scan.points[i - 1].ring)
            runs.back().end = i + 1;
        else
            runs.push_back({i, i + 1});
    return runs;
}

/** Where most lasers begin: the earliest of those that begin close to the usual place. */
double beginOf(const std::vector<Run>& runs, const std::vector<double>& azimuths, double sense)
{
    constexpr double kClose = 0.5;  // [rad]
    std::complex<double> sum = 0;
    for (const Run& run : runs) sum += std::polar(1.0, azimuths[run.begin]);
    double usual = std::arg(sum), earliest = 0;
    for (const Run& run : runs)
    {
        const double after = sense * wrapped(azimuths[run.begin] - usual);
        if (std::abs(after) < kClose) earliest = std::min(earliest, after);
    }
    return usual + sense * earliest;
}

std::optional<SweepOrder> laserByLaser(const Scan& scan, const std::vector<double>& azimuths)
{
    if (scan.rings < 2) return {};
    std::vector<Run> runs = runsOf(scan);
    if (static_cast<double>(runs.size()) >
        (1 - kSameRing) * static_cast<double>(scan.points.size()))
        return {};
    const auto is_short = [&](const Run& run) { return run.end - run.begin < kChunks; };
    runs.erase(std::remove_if(runs.begin(), runs.end(), is_short), runs.end());
    double sense = 0, travel = 0;
    for (const Run& run : runs)
    {
        const auto from = azimuths.begin();
        const Chunks chunks = chunksOf(
            {from + static_cast<std::ptrdiff_t>(run.begin),
             from + static_cast<std::ptrdiff_t>(run.end)},
            kChunks / 4);
        if (!chunks.isSteady() || chunks.travel() > kMostTravel) continue;
        sense += chunks.sense;
        travel += chunks.travel();
    }
    const auto lasers = static_cast<double>(runs.size());
    if (travel < kFewestLasers * kLeastTravel || std::abs(sense) < kInSense * lasers) return {};
    SweepOrder order{PointOrder::LaserByLaser, sense < 0 ? -1.0 : 1.0, 0, {}};
    order.first = beginOf(runs, azimuths, order.sense);
    order.turned.reserve(azimuths.size());
    for (const Run& run : runsOf(scan))
        for (std::size_t i = run.begin; i < run.end; i++)
        {
            // Close to the begin, the place in the run tells on which side of it a point is.
            const double place = (static_cast<double>(i - run.begin) + 0.5) /
                                 static_cast<double>(run.end - run.begin);
            double turned = order.sense * (azimuths[i] - order.first);
            turned -= kTurn * std::floor(turned / kTurn);
            if (place < 0.25 && turned > 0.75 * kTurn) turned -= kTurn;
            if (place > 0.75 && turned < 0.25 * kTurn) turned += kTurn;
            order.turned.push_back(turned);
        }
    return order;
}
}  // namespace

double azimuthOf(const LidarPoint& point)
{
    return std::atan2(
        static_cast<double>(point.position.y()), static_cast<double>(point.position.x()));
}

double wrapped(double angle)
{
    return std::remainder(angle, kTurn);
}

SweepOrder orderOf(const Scan& scan, const std::vector<double>& stagger)
{
    if (scan.points.size() < kFewestPoints) return {};
    std::vector<double> azimuths;
    azimuths.reserve(scan.points.size());
    for (const LidarPoint& point : scan.points)
        azimuths.push_back(
            azimuthOf(point) - (point.ring < stagger.size() ? stagger[point.ring] : 0));
    if (auto order = inTime(azimuths)) return *order;
    if (auto order = laserByLaser(scan, azimuths)) return *order;
    return {};
}
}  // namespace taut
