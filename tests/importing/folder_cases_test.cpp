/** What people's folders of clouds look like, after public reports. */
#include <gmock/gmock.h>
#include <lzf.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>

#include "import_support.h"
#include "scenes.h"
#include "taut/core/TimeText.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
using testing::Contains;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr int kSweeps = 12;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/** How a program writes a cloud. */
struct CloudStyle
{
    std::string ending = ".pcd";
    std::string field = "timestamp";
    double unit = 1e9;         //!< of the times [ns]
    bool since_stamp = false;  //!< else absolute
    Duration clock_shift = 0;  //!< of absolute times
    bool single_precision = false;
    std::size_t hole_every = 0;   //!< rows of NaN, as an organised cloud has them
    bool timeless_holes = false;  //!< their times are NaN, too
    bool compressed = false;      //!< of PCD files
    std::size_t zero_every = 0;   //!< times of zero
    double intensity_scale = 1;
};

class AReportedFolder : public testing::Test
{
 protected:
    AReportedFolder()
    {
        SpinningLidar lidar;
        lidar.rings = 4;
        lidar.columns = 300;
        for (int k = 0; k < kSweeps; k++)
        {
            Scan scan = lidar.scan(Scene{}, 1 + static_cast<unsigned>(k));
            scan.stamp = kStart + k * lidar.period;
            for (auto& point : scan.points)
            {
                point.offset -= point.offset % 1000;
                point.intensity = static_cast<float>((point.ring * 7 + k) % 256);
            }
            scan.end = scan.stamp + scan.points.back().offset;
            scans_.push_back(scan);
        }
        fs::create_directories(folder_ / "in");
    }

    std::string path(const std::string& name) const { return folder_ / ("in/" + name); }

    void writeImu(const std::string& before = "") const
    {
        std::ofstream file(path("imu.csv"));
        file << before << "t,gyro_x,gyro_y,gyro_z,accel_x,accel_y,accel_z\n";
        for (int i = 0; i < 10 * kSweeps; i++)
            file << formatSeconds(kStart + i * 10 * kMillisecond) << ",0.01,0,0,0,0,9.81\n";
    }

    template <class T>
    static void put(std::string& to, T value)
    {
        const auto* bytes = reinterpret_cast<const char*>(&value);
        to.append(bytes, sizeof value);
    }

    void writeCloud(const std::string& name, const Scan& scan, const CloudStyle& style) const
    {
        std::string rows;
        std::size_t n = 0;
        for (std::size_t i = 0; i < scan.points.size(); i++)
        {
            const LidarPoint& p = scan.points[i];
            const bool hole = style.hole_every > 0 && i % style.hole_every == 0;
            const Time t = style.since_stamp ? p.offset : scan.timeOf(p) + style.clock_shift;
            const bool zero = style.zero_every > 0 && i % style.zero_every == 0;
            const double time = zero ? 0
                                : hole && style.timeless_holes
                                    ? double{kNaN}
                                    : static_cast<double>(t / 1'000'000'000) * (1e9 / style.unit) +
                                          static_cast<double>(t % 1'000'000'000) / style.unit;
            for (int axis = 0; axis < 3; axis++) put(rows, hole ? kNaN : p.position[axis]);
            put(rows, static_cast<float>(style.intensity_scale * double{p.intensity}));
            put(rows, p.ring);
            if (style.single_precision)
                put(rows, static_cast<float>(time));
            else if (!style.field.empty())
                put(rows, time);
            n++;
        }
        std::ofstream(path(name + style.ending), std::ios::binary)
            << header(style, n) << (style.compressed ? compressed(rows, n) : rows);
    }

    /** Rows of x, y, z, intensity (4 bytes), ring (2) and, if timed, a time (8) as a compressed PCD
     * file has them. */
    static std::string compressed(const std::string& rows, std::size_t n)
    {
        std::string fields;
        std::size_t begin = 0;
        for (const std::size_t size : {4, 4, 4, 4, 2, 8})
        {
            for (std::size_t i = 0; i < n; i++) fields += rows.substr(i * 26 + begin, size);
            begin += size;
        }
        std::string bytes(2 * fields.size(), '\0');
        bytes.resize(lzf_compress(
            fields.data(), static_cast<unsigned>(fields.size()), bytes.data(),
            static_cast<unsigned>(bytes.size())));
        std::string all;
        put(all, static_cast<std::uint32_t>(bytes.size()));
        put(all, static_cast<std::uint32_t>(fields.size()));
        return all + bytes;
    }

    static std::string header(const CloudStyle& style, std::size_t n)
    {
        const std::string count = std::to_string(n);
        const bool timed = !style.field.empty();
        if (style.ending == ".ply")
            return "ply\nformat binary_little_endian 1.0\nelement vertex " + count +
                   "\nproperty float x\nproperty float y\nproperty float z\nproperty float "
                   "intensity\nproperty ushort ring\n" +
                   (timed ? std::string("property ") +
                                (style.single_precision ? "float " : "double ") + style.field + "\n"
                          : std::string()) +
                   "end_header\n";
        const std::string bytes = style.single_precision ? " 4" : " 8";
        return "VERSION 0.7\nFIELDS x y z intensity ring" + (timed ? " " + style.field : "") +
               "\nSIZE 4 4 4 4 2" + (timed ? bytes : "") + "\nTYPE F F F F U" +
               (timed ? " F" : "") + "\nCOUNT 1 1 1 1 1" + (timed ? " 1" : "") + "\nWIDTH " +
               count + "\nHEIGHT 1\nPOINTS " + count + "\nDATA binary" +
               (style.compressed ? "_compressed" : "") + "\n";
    }

    /** Named by the stamps in a unit [ns], or by numbers. */
    void writeClouds(const CloudStyle& style, Time unit_of_names = 0) const
    {
        writeImu();
        for (int k = 0; k < kSweeps; k++)
            writeCloud(
                unit_of_names > 0 ? std::to_string(scans_[k].stamp / unit_of_names)
                                  : "cloud" + std::to_string(k),
                scans_[k], style);
    }

    Imported import(const ImportOptions& options = {}) const
    {
        return importAll(folder_ / "in", options);
    }

    /** Without every n-th point. */
    std::vector<Scan> withoutEvery(std::size_t n) const
    {
        auto scans = scans_;
        for (Scan& scan : scans)
        {
            std::vector<LidarPoint> kept;
            for (std::size_t i = 0; i < scan.points.size(); i++)
                if (i % n != 0) kept.push_back(scan.points[i]);
            scan.points = kept;
        }
        return scans;
    }

    static void expectScans(
        const std::vector<Scan>& got, const std::vector<Scan>& want, Duration tolerance)
    {
        ASSERT_EQ(got.size(), want.size());
        for (std::size_t k = 0; k < got.size(); k++)
        {
            EXPECT_FALSE(got[k].already_undistorted);
            EXPECT_LE(std::abs(got[k].end - want[k].end), tolerance);
            ASSERT_EQ(got[k].points.size(), want[k].points.size());
            for (std::size_t i = 0; i < got[k].points.size(); i++)
            {
                const LidarPoint &a = got[k].points[i], &b = want[k].points[i];
                ASSERT_EQ(a.position, b.position);
                ASSERT_EQ(a.intensity, b.intensity);
                ASSERT_LE(std::abs(got[k].timeOf(a) - want[k].timeOf(b)), tolerance);
            }
        }
    }

    TemporaryFolder folder_;
    std::vector<Scan> scans_;
};

TEST_F(AReportedFolder, HasTimesUnderTheNamesThatDriversWrite)
{
    writeClouds({});
    const Imported pcd = import();
    expectScans(pcd.scans, scans_, 300);
    EXPECT_THAT(pcd.findings, Contains(HasSubstr("timestamp in s")));
    EXPECT_TRUE(pcd.warnings.counts().empty());

    fs::remove_all(folder_ / "in");
    fs::create_directories(folder_ / "in");
    CloudStyle ply;
    ply.ending = ".ply";
    ply.field = "scalar_GpsTime";
    writeClouds(ply);
    expectScans(import().scans, scans_, 300);
}

TEST_F(AReportedFolder, OfTimesThatCountFromTheStampInTheNameUsesBoth)
{
    CloudStyle style;
    style.field = "time_offset_ns";
    style.unit = 1;
    style.since_stamp = true;
    writeClouds(style, 1);
    expectScans(import().scans, scans_, 0);

    fs::remove_all(folder_ / "in");
    fs::create_directories(folder_ / "in");
    writeClouds(style);
    const Imported nameless = import();
    EXPECT_THAT(nameless.warnings.kept().at(0).text, HasSubstr("its name is no stamp"));
}

TEST_F(AReportedFolder, OfSeveralUnknownTimesStopsAndNamesThem)
{
    writeImu();
    std::ofstream(path("1.csv")) << "x,y,z,shot_time,echo_stamp\n1,2,3,4,5\n";
    EXPECT_THAT(
        import().failure,
        testing::AllOf(HasSubstr("'shot_time', 'echo_stamp'"), HasSubstr("--time-field")));
}

TEST_F(AReportedFolder, OfTimesWithTooFewDigitsIsRefused)
{
    CloudStyle style;
    style.single_precision = true;
    style.clock_shift = -kStart + 300'000'000'000'000;  // seconds of the week
    writeClouds(style, 1);
    EXPECT_THAT(import().failure, testing::AllOf(HasSubstr("timestamp"), HasSubstr("too coarse")));
    ImportOptions options;
    options.time_field = "none";
    EXPECT_EQ(import(options).scans.size(), scans_.size());
}

class ANameOfAFile : public AReportedFolder, public testing::WithParamInterface<Time>
{
};

TEST_P(ANameOfAFile, IsAStampInTheUnitThatTheSpacingTells)
{
    CloudStyle style;
    style.field = "";
    writeClouds(style, GetParam());
    ImportOptions options;
    options.scan_times = ScanTimes::None;
    const Imported all = import(options);
    ASSERT_EQ(all.scans.size(), scans_.size());
    for (std::size_t k = 0; k < scans_.size(); k++) EXPECT_EQ(all.scans[k].stamp, scans_[k].stamp);
    EXPECT_THAT(all.findings, Contains(HasSubstr("names of the clouds: ")));
    EXPECT_TRUE(all.warnings.counts().empty());
}

INSTANTIATE_TEST_SUITE_P(Units, ANameOfAFile, testing::Values(1, 1000, 1'000'000));

TEST_F(AReportedFolder, OfASingleCloudHasItsUnitFromTheTimesOfTheImu)
{
    writeImu();
    CloudStyle style;
    style.field = "";
    writeCloud(std::to_string(scans_[5].stamp / 1000), scans_[5], style);
    const Imported all = import();
    ASSERT_EQ(all.scans.size(), 1U);
    EXPECT_EQ(all.scans[0].stamp, scans_[5].stamp);
}

TEST_F(AReportedFolder, OfOrganisedCloudsDropsRowsThatAreNoReturns)
{
    for (const std::string ending : {".pcd", ".ply"})
    {
        CloudStyle style;
        style.ending = ending;
        style.hole_every = 9;  // 11 %
        style.field = "t";
        fs::remove_all(folder_ / "in");
        fs::create_directories(folder_ / "in");
        writeClouds(style);
        const Imported all = import();
        expectScans(all.scans, withoutEvery(9), 300);
        EXPECT_TRUE(all.warnings.counts().empty());
    }
}

TEST_F(AReportedFolder, OfCompressedOrganisedCloudsDropsRowsThatAreNoReturns)
{
    for (const std::string field : {"t", "timestamp"})
    {
        CloudStyle style;
        style.field = field;
        style.compressed = true;
        style.hole_every = 9;
        style.timeless_holes = true;
        fs::remove_all(folder_ / "in");
        fs::create_directories(folder_ / "in");
        writeClouds(style);
        const Imported all = import();
        expectScans(all.scans, withoutEvery(9), 300);
        EXPECT_TRUE(all.warnings.counts().empty());
    }
}

TEST_F(AReportedFolder, WithATimeOfZeroInSomePointsKeepsTheOthers)
{
    for (const std::string field : {"t", "timestamp"})
    {
        CloudStyle style;
        style.field = field;
        style.zero_every = 100;
        fs::remove_all(folder_ / "in");
        fs::create_directories(folder_ / "in");
        writeClouds(style);
        expectScans(import().scans, withoutEvery(100), 300);
    }
}

TEST_F(AReportedFolder, WithIntensitiesUpToOneScalesThem)
{
    CloudStyle style;
    style.field = "t";
    style.intensity_scale = 1 / 255.0;
    writeClouds(style);
    const Imported all = import();
    EXPECT_THAT(all.findings, Contains(HasSubstr("intensity: from 0 to 1, times 255")));
    ASSERT_EQ(all.scans.size(), scans_.size());
    for (std::size_t i = 0; i < scans_[3].points.size(); i++)
        ASSERT_NEAR(all.scans[3].points[i].intensity, scans_[3].points[i].intensity, 1e-3);
}

TEST_F(AReportedFolder, WithAByteOrderMarkIsReadAllTheSame)
{
    CloudStyle style;
    style.field = "t";
    writeClouds(style);
    writeImu("\xEF\xBB\xBF");
    const Imported all = import();
    EXPECT_EQ(all.failure, "");
    EXPECT_EQ(all.imu.size(), 10U * kSweeps);
}
}  // namespace
}  // namespace taut::test
