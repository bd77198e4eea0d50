#include <gmock/gmock.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/rtti/CObject.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <random>

#include "mrpt_support.h"

namespace taut::test
{
using mrpt::obs::CObservation;
using testing::Contains;
using testing::HasSubstr;
using testing::Pair;

namespace
{
// What a size that was believed costs is above 2 GB; sanitizers keep 256 MB of what was freed.
constexpr double kMostGrowth = 600;

/** The most memory that this process has had [MB]. */
double peakMemory()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

/** One of every class of observations that MRPT has, except those that taut reads. */
std::vector<CObservation::Ptr> otherObservations(Time t)
{
    std::vector<CObservation::Ptr> all{mrpt::obs::CObservationPointCloud::Create()};
    for (const auto* id : mrpt::rtti::getAllRegisteredClassesChildrenOf(CLASS_ID(CObservation)))
    {
        const std::string name = id->className;
        if (!id->ptrCreateObject || name == "mrpt::obs::CObservationIMU" ||
            name == "mrpt::obs::CObservationVelodyneScan" ||
            name == "mrpt::obs::CObservationRotatingScan")
            continue;
        all.push_back(std::dynamic_pointer_cast<CObservation>(id->createObject()));
    }
    for (const auto& o : all)
    {
        o->timestamp = mrptTime(t);
        o->sensorLabel = "OTHER_1";
    }
    return all;
}

std::string shortName(const CObservation& o)
{
    const std::string name = o.GetRuntimeClass()->className;
    return name.substr(name.rfind(':') + 1);
}

bool holds(const Bytes& bytes, const std::string& text)
{
    return std::search(bytes.begin(), bytes.end(), text.begin(), text.end()) != bytes.end();
}
}  // namespace

class FalseSize : public RawlogTest
{
 protected:
    /** What is read of these bytes; an error is nothing. */
    Content read(const Bytes& bytes) const
    {
        std::filesystem::remove(path("a.rawlog"));  // a new file is not forced to the disk
        writeFile(path("a.rawlog"), bytes);
        try
        {
            return readAll(path("a.rawlog"));
        }
        catch (const std::runtime_error&)
        {
            Content nothing;
            nothing.incomplete = true;
            return nothing;
        }
    }

    /** Any four bytes of the object, among other objects, may be a large number. */
    void holdAgainstFalseSizes(const mrpt::serialization::CSerializable& object) const
    {
        LogBytes log;
        log.add(mrptImu(kStart)).add(object).add(mrptImu(kStart + kMillisecond));
        log.add(mrptScan(kStart + 1000 * kMillisecond));
        ASSERT_EQ(read(log.bytes()).imu.size(), 2u);
        ASSERT_FALSE(read(log.bytes()).incomplete);
        const double before = peakMemory();
        for (std::size_t at = log.ends()[0]; at + 4 <= log.ends()[1]; at++)
            for (const std::uint32_t claim : {0x7fffffffu, 0xffffffffu, 0x00fffff0u})
            {
                Bytes bytes = log.bytes();
                std::memcpy(bytes.data() + at, &claim, sizeof claim);
                read(bytes);
            }
        EXPECT_LT(peakMemory() - before, kMostGrowth);
    }

    void holdAgainstCuts(const mrpt::serialization::CSerializable& object) const
    {
        LogBytes log;
        log.add(mrptImu(kStart)).add(mrptScan(kStart)).add(object);
        for (std::size_t size = log.ends()[1]; size <= log.ends()[2]; size++)
        {
            const auto content = read(Bytes(log.bytes().begin(), log.bytes().begin() + size));
            EXPECT_EQ(content.imu.size(), 1u);
            EXPECT_GE(content.scans.size(), 1u);
            const bool whole = size == log.ends()[1] || size == log.ends()[2];
            EXPECT_EQ(content.incomplete, !whole) << size;
        }
    }
};

TEST_F(FalseSize, NoSizeInAVelodyneScanIsBelieved)
{
    holdAgainstFalseSizes(mrptScan(kStart));
    holdAgainstCuts(fullVelodyneScan(kStart + kMillisecond));
}

TEST_F(FalseSize, NoSizeInAVelodyneScanOfPacketsIsBelieved)
{
    LogBytes log;
    auto scan = fullVelodyneScan(kStart);
    log.add(mrptImu(kStart)).add(mrptScan(kStart)).add(scan);
    const double before = peakMemory();
    for (std::size_t at = log.ends()[1]; at + 4 <= log.ends()[2]; at++)
    {
        if (at > log.ends()[1] + 250 && at < log.ends()[1] + 2500) continue;  // in a packet
        Bytes bytes = log.bytes();
        const std::uint32_t claim = 0x7ffffff0;
        std::memcpy(bytes.data() + at, &claim, sizeof claim);
        read(bytes);
    }
    EXPECT_LT(peakMemory() - before, kMostGrowth);
}

TEST_F(FalseSize, NoSizeInARangeImageIsBelieved)
{
    LogBytes log;
    log.add(mrptImu(kStart)).add(rotatingScan(kStart)).add(mrptImu(kStart + kMillisecond));
    const auto content = read(log.bytes());
    ASSERT_EQ(content.scans.size(), 1u);
    EXPECT_EQ(content.scans[0].points.size(), 32u * 6u);
    holdAgainstFalseSizes(rotatingScan(kStart));
    holdAgainstCuts(rotatingScan(kStart + kMillisecond));
}

TEST_F(FalseSize, ARangeImageOf65535Times65535EndsTheReadingWithItsSize)
{
    LogBytes log;
    log.add(mrptImu(kStart)).add(mrptScan(kStart));
    auto scan = rotatingScan(kStart);
    const std::size_t begin = log.bytes().size();
    log.add(scan);
    const Bytes size{6, 0, 32, 0, 500 % 256, 500 / 256};
    auto& bytes = log.bytes();
    const auto at = std::search(bytes.begin() + begin, bytes.end(), size.begin(), size.end());
    ASSERT_NE(at, bytes.end());
    std::fill(at, at + 4, 0xff);
    const auto content = read(bytes);
    EXPECT_TRUE(content.incomplete);
    EXPECT_EQ(content.scans.size(), 1u);
    ASSERT_EQ(content.warnings.count("rawlog_truncated"), 1u);
    EXPECT_THAT(content.warnings.kept()[0].text, HasSubstr("claims 4294836225 elements"));
}

TEST_F(FalseSize, NoSizeInAnImuSampleIsBelieved)
{
    auto imu = mrptImu(kStart);
    imu.timestamp = INVALID_TIMESTAMP;
    holdAgainstFalseSizes(imu);
    holdAgainstCuts(imu);
}

TEST_F(FalseSize, NoSizeInASensoryFrameIsBelieved)
{
    mrpt::obs::CSensoryFrame frame;
    frame.insert(mrpt::obs::CObservationVelodyneScan::Create(mrptScan(kStart)));
    holdAgainstFalseSizes(frame);
}

TEST_F(FalseSize, NoSizeInAnyOtherClassIsBelieved)
{
    for (const auto& other : otherObservations(kStart)) holdAgainstFalseSizes(*other);
}

TEST_F(FalseSize, EveryOtherClassIsPassedOverAndCountedWithItsLabel)
{
    for (const auto& other : otherObservations(kStart))
    {
        SCOPED_TRACE(shortName(*other));
        LogBytes log;
        log.add(*other);
        const std::string label = holds(log.bytes(), "OTHER_1") ? "OTHER_1" : "";
        log.add(mrptImu(kStart)).add(*other).add(*other).add(mrptScan(kStart)).add(*other);
        const auto content = read(log.bytes());
        EXPECT_FALSE(content.incomplete);
        EXPECT_EQ(content.imu.size(), 1u);
        EXPECT_EQ(content.scans.size(), 1u);
        const auto& sensors = content.progress.sensors;
        EXPECT_THAT(sensors, Contains(Pair(Pair(label, shortName(*other)), 4u)));
        EXPECT_EQ(sensors.size(), 3u);
    }
}

TEST_F(FalseSize, OtherClassesArePassedOverInSensoryFrames)
{
    LogBytes log;
    mrpt::obs::CActionCollection actions;
    actions.insert(mrpt::obs::CActionRobotMovement2D());
    actions.insert(mrpt::obs::CActionRobotMovement2D());
    std::size_t frames = 0;
    for (const auto& other : otherObservations(kStart))
    {
        const Time t = kStart + static_cast<Time>(frames++) * kMillisecond;
        mrpt::obs::CSensoryFrame frame;
        frame.insert(other);
        frame.insert(mrpt::obs::CObservationIMU::Create(mrptImu(t)));
        frame.insert(other);
        frame.insert(other);
        log.add(actions).add(frame).add(mrpt::obs::CSensoryFrame());
    }
    mrpt::obs::CSensoryFrame last;
    last.insert(mrpt::obs::CObservationVelodyneScan::Create(mrptScan(kStart)));
    log.add(last);
    const auto content = read(log.bytes());
    EXPECT_FALSE(content.incomplete);
    EXPECT_EQ(content.imu.size(), frames);
    EXPECT_EQ(content.scans.size(), 1u);
}

TEST_F(FalseSize, AnObjectLargerThanTheBufferIsPassedOverWhole)
{
    mrpt::obs::CObservationComment comment;
    comment.text.assign(300'000, static_cast<char>(0x88));  // a mark at every place
    LogBytes log;
    log.add(mrptImu(kStart)).add(comment).add(mrptScan(kStart));
    const auto content = read(log.bytes());
    EXPECT_FALSE(content.incomplete);
    EXPECT_EQ(content.scans.size(), 1u);
}

TEST_F(FalseSize, AnyMutationOfALogIsReadToAnEndInBoundedMemory)
{
    LogBytes log;
    log.add(mrptImu(kStart)).add(mrptScan(kStart)).add(rotatingScan(kStart));
    mrpt::obs::CSensoryFrame frame;
    for (const auto& other : otherObservations(kStart)) frame.insert(other);
    frame.insert(mrpt::obs::CObservationIMU::Create(mrptImu(kStart + kMillisecond)));
    log.add(frame).add(fullVelodyneScan(kStart + kMillisecond)).add(mrptImu(kStart));
    std::mt19937 random(7);
    const auto below = [&random](std::size_t n) { return random() % n; };
    const double before = peakMemory();
    for (int round = 0; round < 4000; round++)
    {
        Bytes bytes = log.bytes();
        for (std::size_t changes = 1 + below(4); changes > 0; changes--)
        {
            const std::size_t at = below(bytes.size()), n = 1 + below(8);
            const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
            const auto end = begin + static_cast<std::ptrdiff_t>(std::min(n, bytes.size() - at));
            switch (below(5))
            {
                case 0:
                    std::fill(begin, end, 0xff);
                    break;
                case 1:
                    std::fill(begin, end, 0);
                    break;
                case 2:
                    std::generate(begin, end, [&] { return random() & 0xff; });
                    break;
                case 3:
                    bytes.erase(begin, end);
                    break;
                default:
                    bytes.insert(begin, n, static_cast<std::uint8_t>(below(256)));
            }
        }
        const auto content = read(bytes);
        EXPECT_LE(content.scans.size(), 4u);
    }
    EXPECT_LT(peakMemory() - before, kMostGrowth);
}

TEST_F(FalseSize, APipeIsAnErrorAtOnce)
{
    ASSERT_EQ(::mkfifo(path("pipe.rawlog").c_str(), 0600), 0);
    try
    {
        readAll(path("pipe.rawlog"));
        FAIL();
    }
    catch (const std::runtime_error& e)
    {
        EXPECT_THAT(e.what(), HasSubstr("not a regular file"));
    }
}

TEST_F(FalseSize, LabelsAreValidUtf8)
{
    const std::string latin = "W\xe4nde \xf0\x9f",
                      valid = "W\xef\xbf\xbdnde \xef\xbf\xbd\xef\xbf\xbd";
    const std::string good = "T\xc3\xbcr \xe2\x82\xac \xf0\x9f\x98\x80";
    mrpt::obs::CObservationGPS gps;
    gps.timestamp = mrptTime(kStart);
    gps.sensorLabel = "\xff";
    LogBytes log;
    log.add(mrptImu(kStart, good)).add(gps).add(mrptScan(kStart, latin));
    const auto content = read(log.bytes());
    EXPECT_EQ(content.progress.imu_label, good);
    EXPECT_EQ(content.progress.lidar_label, valid);
    ASSERT_EQ(content.scans.size(), 1u);
    EXPECT_EQ(content.scans[0].sensor_label, valid);
    EXPECT_EQ(content.progress.sensors.count({"\xef\xbf\xbd", "CObservationGPS"}), 1u);
}

/* The bytes of older versions are made by hand: MRPT writes its own version alone. */
class OlderVersion : public FalseSize
{
 protected:
    static Bytes bytesOf(const mrpt::serialization::CSerializable& object)
    {
        return LogBytes().add(object).bytes();
    }
    static std::size_t versionAt(const Bytes& bytes) { return 1u + (bytes[0] & 0x7fu); }

    /** The object between an IMU sample and a scan. */
    Content readBetween(const Bytes& object) const
    {
        LogBytes log;
        Bytes bytes = log.add(mrptImu(kStart)).bytes();
        bytes.insert(bytes.end(), object.begin(), object.end());
        const Bytes scan = bytesOf(mrptScan(kStart + 1000 * kMillisecond));
        bytes.insert(bytes.end(), scan.begin(), scan.end());
        return read(bytes);
    }
};

TEST_F(OlderVersion, ImuSamplesOfVersionsTwoAndThreeAreRead)
{
    constexpr std::size_t kPose = 1 + 20 + 1 + 12 * 8 + 1, kValues = 31;
    const Bytes size{kValues, 0, 0, 0};
    for (const auto version : {std::uint8_t{2}, std::uint8_t{3}})
    {
        Bytes bytes = bytesOf(mrptImu(kStart + kMillisecond, "IMU", {0, {1, 2, 3}, {4, 5, 6}}));
        bytes[versionAt(bytes)] = version;
        const std::size_t present = versionAt(bytes) + 1 + kPose, values = present + kValues + 8;
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(values), size.begin(), size.end());
        bytes.insert(
            bytes.begin() + static_cast<std::ptrdiff_t>(present), size.begin(), size.end());
        const auto content = readBetween(bytes);
        EXPECT_FALSE(content.incomplete);
        ASSERT_EQ(content.imu.size(), 2u);
        EXPECT_EQ(content.imu[1].gyro, Vector3d(1, 2, 3));
        EXPECT_EQ(content.imu[1].accel, Vector3d(4, 5, 6));
        EXPECT_EQ(content.scans.size(), 1u);
    }
}

TEST_F(OlderVersion, VelodyneScansOfVersionsZeroAndOneAreRead)
{
    constexpr std::size_t kPoints = 100, kTexts = 15 + 12 + 15 + 25, kSizes = 4 * 4;
    for (const auto version : {std::uint8_t{0}, std::uint8_t{1}})
    {
        Bytes bytes = bytesOf(mrptScan(kStart));
        bytes[versionAt(bytes)] = version;
        bytes.resize(bytes.size() - 1 - kTexts - kSizes - kPoints * (8 + 2) - (version == 0));
        bytes.push_back(0x88);
        const auto content = readBetween(bytes);
        EXPECT_FALSE(content.incomplete);
        ASSERT_EQ(content.scans.size(), 2u);
        EXPECT_EQ(content.scans[0].points.size(), kPoints);
    }
}

TEST_F(OlderVersion, AVersionThatIsNotKnownEndsTheReadingWithItsNumber)
{
    Bytes bytes = bytesOf(mrptImu(kStart));
    bytes[versionAt(bytes)] = 9;
    LogBytes log;
    log.add(mrptImu(kStart)).add(mrptScan(kStart));
    bytes.insert(bytes.begin(), log.bytes().begin(), log.bytes().end());
    const auto content = read(bytes);
    EXPECT_TRUE(content.incomplete);
    ASSERT_EQ(content.warnings.count("rawlog_truncated"), 1u);
    EXPECT_THAT(content.warnings.kept()[0].text, HasSubstr("version 9"));
}

TEST_F(FalseSize, BooleansAreAnyNumberButZero)
{
    LogBytes log;
    log.add(mrptImu(kStart)).add(mrptScan(kStart));
    constexpr std::size_t kPresent = 1 + 26 + 1 + 1 + 20 + 1 + 12 * 8 + 1;
    ASSERT_EQ(log.bytes()[kPresent], 1);
    log.bytes()[kPresent] = 58;
    EXPECT_EQ(read(log.bytes()).imu.size(), 1u);
}

TEST_F(FalseSize, StampsFarFromOurCenturyAreNone)
{
    for (const std::int64_t ticks :
         {std::int64_t{1}, std::numeric_limits<std::int64_t>::max(),
          std::numeric_limits<std::int64_t>::min()})
    {
        auto imu = mrptImu(kStart);
        imu.timestamp = mrpt::Clock::time_point(mrpt::Clock::duration(ticks));
        auto scan = mrptScan(kStart);
        scan.point_cloud.timestamp[3] = imu.timestamp;
        LogBytes log;
        const auto content = read(log.add(mrptImu(kStart)).add(imu).add(scan).bytes());
        EXPECT_EQ(content.imu.size(), 1u);
        EXPECT_EQ(content.warnings.count("no_stamp"), 1u);
        ASSERT_EQ(content.scans.size(), 1u);
        EXPECT_EQ(content.scans[0].points.size(), 99u);
        EXPECT_EQ(content.progress.points_bad_time, 1u);
    }
}

TEST_F(FalseSize, ASmallFileThatDecompressesToMuchDoesNotFillTheMemory)
{
    LogBytes log;
    log.add(mrptImu(kStart)).add(mrptScan(kStart));
    const Bytes zeros(1u << 20);
    for (const std::uint32_t length : {0xfffffffeu, 300u << 20})
    {
        mrpt::obs::CObservationComment comment;
        comment.text = std::string(3, 'x');
        LogBytes end;
        end.add(comment).add(mrptImu(kStart + kMillisecond));
        const double before = peakMemory();
        const auto file = gzopen(path("a.rawlog").c_str(), "wb1");
        gzwrite(file, log.bytes().data(), static_cast<unsigned>(log.bytes().size()));
        const std::size_t text = 1 + 30 + 1;  // its length, then the letters
        gzwrite(file, end.bytes().data(), text);
        gzwrite(file, &length, sizeof length);
        for (int i = 0; i < 300; i++) gzwrite(file, zeros.data(), 1u << 20);
        const std::size_t rest = text + sizeof length + 3;
        gzwrite(file, end.bytes().data() + rest, static_cast<unsigned>(end.bytes().size() - rest));
        gzclose(file);
        const auto content = readAll(path("a.rawlog"));
        EXPECT_EQ(content.scans.size(), 1u);
        EXPECT_EQ(content.imu.size(), 2u);
        EXPECT_LT(peakMemory() - before, 100);
    }
}
}  // namespace taut::test
