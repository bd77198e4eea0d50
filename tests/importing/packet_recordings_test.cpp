/** Bags of real packets (TAUT_DATA) against the points that an independent decoder made of one
 * sweep each. */
#include <algorithm>
#include <cmath>
#include <complex>
#include <unordered_map>

#include "data_folder.h"
#include "import_support.h"
#include "taut/files/PcdFile.h"
#include "taut/packets/velodyne/Decoder.h"

namespace taut::test
{
namespace
{
using Points = std::vector<Eigen::Vector3f>;

/** Finds whether a point has a neighbour within `reach`. */
class Neighbours
{
 public:
    explicit Neighbours(const Points& points)
    {
        for (const auto& p : points) cells_[keyOf(cellOf(p))].push_back(p);
    }

    bool near(const Eigen::Vector3f& p) const
    {
        const Eigen::Vector3i cell = cellOf(p);
        for (int i = 0; i < 27; i++)
        {
            const auto found =
                cells_.find(keyOf(cell + Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
            if (found == cells_.end()) continue;
            for (const auto& q : found->second)
                if ((q - p).norm() <= kReach) return true;
        }
        return false;
    }

    /** Of the points up to some range [m]. */
    double shareNear(const Points& points, double farthest) const
    {
        std::size_t compared = 0, count = 0;
        for (const auto& p : points)
        {
            if (p.norm() > farthest) continue;
            compared++;
            count += near(p) ? 1 : 0;
        }
        return static_cast<double>(count) / static_cast<double>(compared);
    }

 private:
    static constexpr float kReach = 0.01F;  // [m]

    static Eigen::Vector3i cellOf(const Eigen::Vector3f& p)
    {
        return (p / kReach).array().floor().cast<int>();
    }
    static std::int64_t keyOf(const Eigen::Vector3i& cell)
    {
        return (cell.x() * 1'000'003LL + cell.y()) * 1'000'003LL + cell.z();
    }

    std::unordered_map<std::int64_t, Points> cells_;
};

/** A bag, what its sensor is, and in what the other decoder differs. */
struct Recording
{
    const char* name;
    const char* finding;                //!< that the summary must have
    const char* correction = nullptr;   //!< correction file of the truth
    double shortest = 0;                //!< range that the truth begins with [m]
    double count = 0.005, near = 0.99;  //!< shares: of difference, and of points within 1 cm
    bool truth_turns_otherwise = false;
    double farthest = 1000;  //!< that is compared [m]: the truth counts azimuths in 0.01 deg
};

void PrintTo(const Recording& recording, std::ostream* out)
{
    *out << recording.name;
}

/** The independent decoder turns the returns of a firing on by other times than the manuals give:
 * on a VLP-32C lasers follow each other where they fire in pairs; on a VLS-128 three banks of four
 * are not turned on. [ns] to add to the time that a laser is turned on by. */
double otherTime(const velodyne::FiringPattern& pattern, int laser)
{
    const double time = pattern.laserTime(laser);
    if (pattern.lasers == 32) return laser * pattern.laser_period - time;
    return laser < 96 ? -time : 0;
}

Points pointsOf(const Scan& scan, const Recording& recording)
{
    const auto& pattern = velodyne::firingPattern(
        scan.rings == 32 ? velodyne::Model::Vlp32 : velodyne::Model::Vls128);
    Points points;
    for (const LidarPoint& p : scan.points)
    {
        if (p.position.norm() < recording.shortest) continue;
        const double turned =
            recording.truth_turns_otherwise ? 3600e-9 * otherTime(pattern, p.ring) : 0;  // [deg]
        const auto angle = static_cast<float>(-turned * M_PI / 180);
        points.push_back(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()) * p.position);
    }
    return points;
}

/** The head turns at 10 Hz, clockwise: its azimuth tells the time, but for where a laser looks from
 * it. */
void expectTimesOfTheTurn(const Scan& scan)
{
    constexpr double kRate = 3600e-9;  // [deg/ns]
    constexpr double kAside = 15;      // [deg]
    EXPECT_LT(scan.end - scan.stamp, 101 * kMillisecond);
    EXPECT_GT(scan.end - scan.stamp, 49 * kMillisecond);
    const auto begin = [](const LidarPoint& p)  // of the turn, as this point tells it [deg]
    { return std::atan2(-p.position.y(), p.position.x()) * 180 / M_PI - kRate * p.offset; };
    std::complex<double> mean;
    for (const LidarPoint& p : scan.points) mean += std::polar(1.0, begin(p) * M_PI / 180);
    const double expected = std::arg(mean) * 180 / M_PI;
    for (const LidarPoint& p : scan.points)
    {
        ASSERT_LT(std::abs(std::remainder(begin(p) - expected, 360)), kAside);
        ASSERT_GE(p.offset, 0);
        ASSERT_LE(scan.timeOf(p), scan.end);
    }
}

class APacketBag : public testing::TestWithParam<Recording>
{
 protected:
    /** False where the recording is absent. */
    bool import()
    {
        const auto data = dataFolder() / "packets";
        const auto bag = data / GetParam().name;
        if (!std::filesystem::exists(bag)) return false;
        for (const auto& entry : std::filesystem::directory_iterator(bag))
            if (entry.path().extension() == ".pcd") truth_ = readTruth(entry.path().string());
        ImportOptions options;
        if (GetParam().correction)
            options.hesai_csv = (data / "calibration" / GetParam().correction).string();
        all_ = importAll(bag.string(), options);
        return true;
    }

    static Points readTruth(const std::string& path)
    {
        PcdReader file(path);
        Points points;
        for (std::vector<double> row; file.next(row);)
            points.push_back(Eigen::Vector3d(row[0], row[1], row[2]).cast<float>());
        return points;
    }

    Imported all_;
    Points truth_;
};

TEST_P(APacketBag, HasThePointsOfAnIndependentDecoderAndATimeForEach)
{
    const Recording& recording = GetParam();
    if (!import()) return skipWithout(std::string("packets/") + recording.name);
    ASSERT_EQ(all_.failure, "");
    EXPECT_EQ(all_.warnings.counts().size(), 1U);
    EXPECT_EQ(all_.warnings.count("no_imu"), 1U);
    EXPECT_NE(
        std::find(all_.findings.begin(), all_.findings.end(), recording.finding),
        all_.findings.end());

    const Neighbours truth(truth_);
    const Scan* scan = nullptr;
    Points points;
    double best = 0;
    for (const Scan& candidate : all_.scans)
    {
        const Points moved = pointsOf(candidate, recording);
        const double count =
            truth.shareNear(moved, recording.farthest) * static_cast<double>(moved.size());
        if (count <= best) continue;
        best = count;
        scan = &candidate;
        points = moved;
    }
    ASSERT_NE(scan, nullptr);
    expectTimesOfTheTurn(*scan);
    const double size = static_cast<double>(points.size());
    EXPECT_NEAR(size / static_cast<double>(truth_.size()), 1, recording.count);
    EXPECT_GT(truth.shareNear(points, recording.farthest), recording.near);
    EXPECT_GT(Neighbours(points).shareNear(truth_, recording.farthest), recording.near);
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, APacketBag,
    testing::Values(
        Recording{"hesai_40p", "Hesai Pandar40P, two returns: 1439 packets", "Pandar40P.csv"},
        Recording{"hesai_64", "Hesai Pandar64, two returns: 2400 packets", "Pandar64.csv"},
        Recording{"hesai_qt64", "Hesai PandarQT, two returns: 1200 packets", "PandarQT64.csv"},
        Recording{"hesai_qt128", "Hesai QT128, two returns: 1800 packets", "PandarQT128.csv", 0.3},
        Recording{"hesai_xt32", "Hesai PandarXT, two returns: 2000 packets", "PandarXT32.csv"},
        Recording{"hesai_xt32m", "Hesai XT32M, two returns: 1815 packets", "PandarXT32M.csv"},
        // The last block of each packet is not turned on at all in the truth.
        Recording{
            "velodyne_vlp32", "Velodyne VLP-32C, strongest return: 379 packets", nullptr, 0, 0.005,
            0.95, true},
        // The truth leaves out the last 1.5 degrees, and more behind.
        Recording{
            "velodyne_vls128", "Velodyne VLS-128, strongest return: 2193 packets", nullptr, 0,
            0.007, 0.9, true, 40}),
    [](const auto& parameter) { return std::string(parameter.param.name); });
}  // namespace
}  // namespace taut::test
