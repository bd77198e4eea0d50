#include "taut/trajectory/PointTruth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "taut/core/writeError.h"
#include "taut/trajectory/Scores.h"
#include "taut/trajectory/TrajectoryFile.h"

namespace taut
{
namespace
{
constexpr std::array<char, 8> kMagic{'T', 'A', 'U', 'T', 'P', 'N', 'T', 'S'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kMaxPoints = 50'000'000;  // a scan of more is a broken file
constexpr Duration kSameStamp = 1000;
constexpr Duration kNever = std::numeric_limits<Duration>::max();

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the file is little endian");

template <class T>
void put(std::ostream& out, const T& value)
{
    std::array<char, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof(T));
    out.write(bytes.data(), bytes.size());
}

template <class T>
bool get(std::istream& in, T& value)
{
    std::array<char, sizeof(T)> bytes{};
    if (!in.read(bytes.data(), bytes.size())) return false;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return true;
}

/** The sums of one scan, or of all. */
struct Sums
{
    std::size_t points = 0, missing = 0;
    double squares = 0, errors = 0, max = 0;

    double rmse() const
    {
        return points == 0 ? 0 : std::sqrt(squares / static_cast<double>(points));
    }
    void add(const Sums& other)
    {
        points += other.points;
        missing += other.missing;
        squares += other.squares;
        errors += other.errors;
        max = std::max(max, other.max);
    }
};

Sums compare(const UndistortedScan& truth, const UndistortedScan& estimate)
{
    if (truth.positions.size() != estimate.positions.size())
        throw std::runtime_error(
            "the scan at " + formatSeconds(estimate.stamp) + " s has " +
            std::to_string(estimate.positions.size()) + " points, its truth " +
            std::to_string(truth.positions.size()));
    Sums sums;
    for (std::size_t i = 0; i < truth.positions.size(); i++)
    {
        if (!truth.positions[i].allFinite()) continue;
        if (!estimate.positions[i].allFinite())
        {
            sums.missing++;
            continue;
        }
        const double error =
            (estimate.positions[i].cast<double>() - truth.positions[i].cast<double>()).norm();
        sums.points++;
        sums.errors += error;
        sums.squares += error * error;
        sums.max = std::max(sums.max, error);
    }
    return sums;
}
void refuseTooLittle(
    const PointScores& scores, Duration closest, double min_coverage, const std::string& path)
{
    const auto enough = [&](std::size_t n, std::size_t of)
    { return n > 0 && static_cast<double>(n) >= min_coverage * static_cast<double>(of); };
    if (!enough(scores.scans, scores.truth_scans))
        throw ScoreRefused(
            "refused: '" + path + "' holds " + std::to_string(scores.scans) + " of the " +
            std::to_string(scores.truth_scans) + " scans with true points" +
            (closest == kNever
                 ? ""
                 : "; the closest stamps differ by " + formatSeconds(closest) + " s"));
    if (!enough(scores.points, scores.points + scores.missing))
        throw ScoreRefused(
            "refused: '" + path + "' holds " + std::to_string(scores.points) + " of the " +
            std::to_string(scores.points + scores.missing) + " true points");
}
}  // namespace

PointTruthWriter::PointTruthWriter(const std::string& path)
    : path_(path), file_(path, std::ios::binary)
{
    if (!file_) throw writeError(path);
    put(file_, kMagic);
    put(file_, kVersion);
}

void PointTruthWriter::write(const UndistortedScan& scan)
{
    if (scans_++ > 0 && scan.stamp <= last_)
        throw std::invalid_argument(
            path_ + ": the scan at " + formatSeconds(scan.stamp) + " s follows one at " +
            formatSeconds(last_) + " s");
    last_ = scan.stamp;
    put(file_, scan.stamp);
    put(file_, static_cast<std::uint32_t>(scan.positions.size()));
    for (const Eigen::Vector3f& p : scan.positions)
        put(file_, std::array<float, 3>{p.x(), p.y(), p.z()});
    flushOrThrow(file_, path_);
}

void PointTruthWriter::close()
{
    flushOrThrow(file_, path_);
    file_.close();
}

PointTruthReader::PointTruthReader(const std::string& path)
    : path_(path), file_(path, std::ios::binary)
{
    if (!file_) throw std::runtime_error("cannot read '" + path + "'");
    std::array<char, 8> magic{};
    std::uint32_t version = 0;
    if (!get(file_, magic) || magic != kMagic)
        throw std::runtime_error("'" + path + "' is not a file of undistorted points");
    if (!get(file_, version) || version != kVersion)
        throw std::runtime_error(
            "'" + path + "' has version " + std::to_string(version) + " of the format, not " +
            std::to_string(kVersion));
}

void PointTruthReader::fail(const std::string& what) const
{
    throw std::runtime_error(path_ + ", scan " + std::to_string(scans_) + ": " + what);
}

bool PointTruthReader::next(UndistortedScan& scan)
{
    if (file_.peek() == std::ifstream::traits_type::eof()) return false;
    std::uint32_t count = 0;
    if (!get(file_, scan.stamp) || !get(file_, count)) fail("the file is cut short");
    if (scans_ > 0 && scan.stamp <= last_) fail("its stamp does not increase");
    if (count > kMaxPoints) fail("it claims " + std::to_string(count) + " points");
    last_ = scan.stamp;
    scan.positions.clear();
    for (std::uint32_t i = 0; i < count; i++)
    {
        std::array<float, 3> p{};
        if (!get(file_, p)) fail("the file is cut short");
        scan.positions.emplace_back(p[0], p[1], p[2]);
    }
    scans_++;
    return true;
}

PointScores scorePoints(
    const std::string& truth_path, const std::string& estimate_path, double min_coverage, Time from)
{
    PointTruthReader truth_file(truth_path), estimate_file(estimate_path);
    UndistortedScan truth, estimate;
    bool has_truth = truth_file.next(truth), has_estimate = estimate_file.next(estimate);
    while (has_truth && truth.stamp < from) has_truth = truth_file.next(truth);
    while (has_estimate && estimate.stamp < from) has_estimate = estimate_file.next(estimate);
    Duration closest = kNever;
    PointScores scores;
    Sums all;
    std::vector<double> by_scan;
    while (has_truth || has_estimate)
    {
        const Duration ahead = has_truth && has_estimate ? estimate.stamp - truth.stamp
                               : has_truth               ? kNever
                                                         : -kNever;
        closest = std::min(closest, std::abs(ahead));
        if (std::abs(ahead) <= kSameStamp)
        {
            const Sums sums = compare(truth, estimate);
            if (by_scan.empty() || sums.rmse() > scores.worst_scan)
            {
                scores.worst_scan = sums.rmse();
                scores.worst_stamp = estimate.stamp;
            }
            by_scan.push_back(sums.rmse());
            all.add(sums);
        }
        if (ahead >= -kSameStamp)
        {
            scores.truth_scans++;
            has_truth = truth_file.next(truth);
        }
        if (ahead <= kSameStamp) has_estimate = estimate_file.next(estimate);
    }
    scores.scans = by_scan.size();
    scores.points = all.points;
    scores.missing = all.missing;
    refuseTooLittle(scores, closest, min_coverage, estimate_path);
    scores.rmse = all.rmse();
    scores.mean = all.errors / static_cast<double>(all.points);
    scores.max = all.max;
    scores.median_scan = statisticsOf(std::move(by_scan)).median;
    return scores;
}
}  // namespace taut
