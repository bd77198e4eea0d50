#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iomanip>

#include "PcapWriter.h"
#include "reference.h"
#include "taut/core/TimeText.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
using testing::Contains;
using testing::HasSubstr;
namespace fs = std::filesystem;

/** One firing sequence of eight: text is slow. */
Reference thinned()
{
    Reference reference(3);
    std::vector<TimedPoint> few;
    for (std::size_t i = 0; i < reference.points.size(); i++)
        if (i / 16 % 8 == 0) few.push_back(reference.points[i]);
    reference.points = few;
    return reference;
}

const Reference& reference()
{
    static const Reference reference = thinned();
    return reference;
}

/** A small cloud file, row by row. */
class CloudFile
{
 public:
    CloudFile(const std::string& path, bool binary) : file_(path), binary_(binary)
    {
        file_ << std::setprecision(17);
    }
    void header(const std::string& text) { file_ << text; }
    void row(const TimedPoint& p, double t)
    {
        if (binary_)
        {
            for (int i = 0; i < 3; i++) put(static_cast<float>(p.position[i]));
            put(static_cast<std::uint8_t>(p.intensity));
            put(static_cast<std::uint16_t>(p.ring));
            put(t);
            return;
        }
        const char separator = comma ? ',' : ' ';
        for (int i = 0; i < 3; i++) file_ << static_cast<float>(p.position[i]) << separator;
        file_ << p.intensity << separator << p.ring << separator << t << "\n";
    }
    bool comma = false;

 private:
    template <class T>
    void put(T value)
    {
        file_.write(reinterpret_cast<const char*>(&value), sizeof value);
    }
    std::ofstream file_;
    bool binary_;
};

std::string plyHeader(bool binary, std::size_t points, const std::string& time)
{
    return std::string("ply\nformat ") + (binary ? "binary_little_endian" : "ascii") +
           " 1.0\nelement vertex " + std::to_string(points) +
           "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar intensity\n"
           "property ushort ring\nproperty double " +
           time + "\nend_header\n";
}

std::string pcdHeader(bool binary, std::size_t points, const std::string& time)
{
    const std::string n = std::to_string(points);
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity ring " + time +
           "\nSIZE 4 4 4 1 2 8\nTYPE F F F U U F\nCOUNT 1 1 1 1 1 1\nWIDTH " + n +
           "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA " +
           (binary ? "binary" : "ascii") + "\n";
}

class APlainFolder : public testing::Test
{
 protected:
    std::string path(const std::string& name) const { return folder_ / ("in/" + name); }

    APlainFolder() { fs::create_directories(folder_ / "in"); }

    void writeImu() const
    {
        std::ofstream file(path("imu.csv"));
        file << "t,gyro_x,gyro_y,gyro_z,accel_x,accel_y,accel_z\n" << std::setprecision(17);
        for (const ImuSample& s : reference().imu)
        {
            file << formatSeconds(s.t);
            for (int i = 0; i < 3; i++) file << "," << s.gyro[i];
            for (int i = 0; i < 3; i++) file << "," << s.accel[i];
            file << "\n";
        }
    }

    /** `style`: ending and whether binary; times absolute or since the stamp in the name. */
    void writeScans(const std::string& ending, bool binary, bool relative) const
    {
        for (int k = 0; k < 3; k++)
        {
            const Time begin = kStart + k * 100 * kMillisecond;
            std::vector<TimedPoint> points;
            for (const TimedPoint& p : reference().points)
                if (p.t >= begin && p.t < begin + 100 * kMillisecond) points.push_back(p);
            const std::string name =
                relative ? formatSeconds(begin) + ending : "scan" + std::to_string(k + 8) + ending;
            CloudFile file(path(name), binary);
            const std::string time = relative ? "dt_ns" : "t";
            if (ending == ".ply") file.header(plyHeader(binary, points.size(), time));
            if (ending == ".pcd") file.header(pcdHeader(binary, points.size(), time));
            if (ending == ".csv") file.header("x,y,z,intensity,ring," + time + "\n");
            file.comma = ending == ".csv";
            for (const TimedPoint& p : points)
                file.row(p, relative ? static_cast<double>(p.t - begin) : toSeconds(p.t));
        }
    }

    Imported import() const { return importAll(folder_ / "in"); }

    const TemporaryFolder folder_;
};

TEST_F(APlainFolder, GivesTheSamePointsFromEveryKindOfFile)
{
    for (const std::string ending : {".csv", ".ply", ".pcd"})
        for (const bool binary : {false, true})
            for (const bool relative : {false, true})
            {
                if (ending == ".csv" && binary) continue;
                SCOPED_TRACE(ending + (binary ? " binary" : " text") + (relative ? " dt" : " t"));
                fs::remove_all(folder_ / "in");
                fs::create_directories(folder_ / "in");
                writeImu();
                writeScans(ending, binary, relative);
                const ReadBack back = importAndRead(folder_ / "in", folder_ / "a.rawlog");
                EXPECT_EQ(back.scans.size(), 3U);
                // A double of seconds tells a quarter of a microsecond.
                expectSame(reference().points, back.points, {1e-6, relative ? 100 : 350, true});
                expectSame(reference().imu, back.imu);
                EXPECT_TRUE(back.warnings.counts().empty());
            }
}

TEST_F(APlainFolder, WithoutTimesOfThePointsIsUndistortedAlready)
{
    fs::create_directories(path("scans"));
    std::ofstream(path("scans/1700000000.500000000.csv")) << "x y z\n1 2 3\n4 5 6\n";
    std::ofstream(path("scans/1700000001500000000.csv")) << "# x y z\n1 2 3\n4 5 6\n";
    writeImu();
    const Imported all = import();
    ASSERT_EQ(all.scans.size(), 2U);
    EXPECT_TRUE(all.scans[0].already_undistorted);
    EXPECT_EQ(all.scans[0].stamp, 1'700'000'000'500'000'000);
    EXPECT_EQ(all.scans[1].stamp, 1'700'000'001'500'000'000);
    EXPECT_THAT(all.findings, Contains(HasSubstr("2 of 2 scans have no times")));
}

TEST_F(APlainFolder, SaysWhatIsMissing)
{
    EXPECT_THAT(import().failure, HasSubstr("no recording that can be imported"));

    std::ofstream(path("1.csv")) << "x,y,z\n1,2,3\n";
    Imported all = import();
    EXPECT_THAT(all.failure, HasSubstr("no scan in"));
    EXPECT_THAT(all.warnings.kept().at(0).text, HasSubstr("no absolute times"));

    std::ofstream(path("1.csv")) << "x,y,t\n1,2,3\n";
    EXPECT_THAT(import().warnings.kept().at(0).text, HasSubstr("lacks a column x, y or z"));
    std::ofstream(path("1.csv")) << "x,y,z,t,dt\n1,2,3,4,5\n";
    EXPECT_THAT(import().warnings.kept().at(0).text, HasSubstr("more than one column of times"));
    std::ofstream(path("1.csv")) << "x,y,z,t\n1,2,3,17\n1,2,x,17\n";
    EXPECT_THAT(import().warnings.kept().at(0).text, HasSubstr("1.csv:3: 'x' is not a number"));
    std::ofstream(path("1.csv")) << "x,y,z,t\n1,2,3,1700000000\n1,2,4,1700000128\n";
    EXPECT_THAT(import().warnings.kept().at(0).text, HasSubstr("single precision"));

    writeScans(".csv", false, false);
    fs::remove(path("1.csv"));
    all = import();
    EXPECT_EQ(all.scans.size(), 3U);
    EXPECT_EQ(all.warnings.count("no_imu"), 1U);
    std::ofstream(path("imu.csv")) << "t,gyro_x\n";
    EXPECT_THAT(import().failure, HasSubstr("no column gyro_y"));
    std::ofstream(path("imu.csv")) << "gyro_x\n";
    EXPECT_THAT(import().failure, HasSubstr("needs one column of times"));
}

TEST_F(APlainFolder, KeepsWhatIsGoodBesideWhatIsNot)
{
    writeImu();
    std::ofstream(path("imu.csv"), std::ios::app) << "1,2,3\n1700000009,a,0,0,0,0,9.8\n";
    writeScans(".ply", true, false);
    fs::resize_file(path("scan9.ply"), 5000);
    const Imported all = import();
    EXPECT_EQ(all.scans.size(), 2U);
    EXPECT_EQ(all.imu.size(), reference().imu.size());
    EXPECT_EQ(all.warnings.count("scan_invalid"), 1U);
    EXPECT_EQ(all.warnings.count("imu_invalid"), 2U);
}

TEST_F(APlainFolder, OfDamagedCompressedPcdFilesSaysSo)
{
    std::string header = pcdHeader(true, 1, "t");
    header.replace(header.find("DATA binary"), 11, "DATA binary_compressed");
    std::ofstream(path("1.pcd")) << header << "12345678";
    EXPECT_THAT(import().warnings.kept().at(0).text, HasSubstr("bytes of compressed data"));
}

// The same recording as the sensor sends it.
TEST(AVlp16, GivesTheSamePointsThroughACaptureAndARawlog)
{
    const Reference sent(3);
    const TemporaryFolder folder;
    {
        PcapWriter pcap(folder / "a.pcap");
        velodyne::PacketWriter writer(velodyne::Model::Vlp16);
        const auto& all = sent.points;
        for (std::size_t i = 0; i < sent.azimuths.size(); i++)
        {
            std::vector<velodyne::Cell> cells(16);
            for (std::size_t laser = 0; laser < 16; laser++)
                cells[laser] = {
                    all[16 * i + laser].position.norm(),
                    static_cast<std::uint8_t>(all[16 * i + laser].intensity)};
            writer.add(all[16 * i].t, sent.azimuths[i], cells);
        }
        for (const auto& packet : writer.take(true))
            pcap.write(kStart + 2 * kMillisecond, 2368, packet);
    }
    const ReadBack back = importAndRead(folder / "a.pcap", folder / "a.rawlog");
    EXPECT_EQ(back.scans.size(), 3U);
    expectSame(sent.points, back.points, {0.003, 1200, true});
}
}  // namespace
}  // namespace taut::test
