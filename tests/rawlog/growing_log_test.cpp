/** Logs that are read while they are written. */
#include <gmock/gmock.h>
#include <mrpt/obs/CObservationComment.h>

#include <thread>

#include "mrpt_support.h"
#include "taut/rawlog/PrefetchedRawlog.h"
#include "taut/rawlog/RawlogRecorder.h"
#include "taut/rawlog/RawlogReplay.h"

namespace taut::test
{
namespace
{
using testing::HasSubstr;

/** All that a stream says, as text, in its order. */
std::string transcript(MeasurementStream& stream)
{
    std::string text;
    while (const auto measurement = stream.next())
    {
        if (const auto* sample = std::get_if<ImuSample>(&*measurement))
            text += "imu " + std::to_string(sample->t) + "\n";
        else
            text += "scan " + std::to_string(std::get<Scan>(*measurement).end) + "\n";
    }
    return text + (stream.incomplete() ? "incomplete" : "complete");
}

mrpt::obs::CObservationComment comment(Time t, const std::string& text)
{
    mrpt::obs::CObservationComment comment;
    comment.timestamp = mrptTime(t);
    comment.sensorLabel = "NOTES";
    comment.text = text;
    return comment;
}
}  // namespace

/** Parameter: the level of the compression, 0 for none. */
class GrowingLog : public RawlogTest, public testing::WithParamInterface<int>
{
 protected:
    GrowingLog()
    {
        config_.path = path("log.rawlog");
        for (int k = 0; k < 50; k++)
        {
            const Time t = kStart + k * 100 * kMillisecond;
            for (int i = 0; i < 10; i++)
                observations_.push_back(std::make_shared<mrpt::obs::CObservationIMU>(
                    mrptImu(t + i * 10 * kMillisecond)));
            if (k % 5 == 2)
                observations_.push_back(std::make_shared<mrpt::obs::CObservationComment>(
                    comment(t, std::string(300, 'x'))));
            observations_.push_back(
                std::make_shared<mrpt::obs::CObservationVelodyneScan>(mrptScan(t)));
        }
    }

    std::string readAgain() const
    {
        RawlogConfig config;
        config.path = config_.path;
        RawlogSource source(config);
        return transcript(source);
    }

    RawlogConfig config_;
    std::vector<mrpt::obs::CObservation::Ptr> observations_;
};

TEST_P(GrowingLog, GivesWhileItIsWrittenWhatItGivesAfterwards)
{
    RawlogRecorder recorder(config_.path, GetParam());
    config_.wait_for_growth = [&] { return recorder.waitForGrowth(); };
    std::thread writer(
        [&]
        {
            for (const auto& observation : observations_) recorder.write(*observation);
            recorder.close();
        });
    std::string live;
    {
        PrefetchedRawlog log(config_);
        live = transcript(log);
    }
    writer.join();
    EXPECT_EQ(recorder.observations(), observations_.size());
    EXPECT_EQ(live, readAgain());
    EXPECT_THAT(live, HasSubstr("complete"));
}

// The writing and the reading take turns here: an observation is written when the reader waits.
TEST_P(GrowingLog, GivesEachMeasurementAsSoonAsItIsWritten)
{
    RawlogRecorder recorder(config_.path, GetParam());
    std::size_t written = 0, foreign = 0;
    config_.wait_for_growth = [&]
    {
        if (written == observations_.size()) recorder.close();
        if (written == observations_.size()) return LogGrowth::Complete;
        foreign += observations_[written]->sensorLabel == "NOTES" ? 1 : 0;
        recorder.write(*observations_[written++]);
        return LogGrowth::More;
    };
    RawlogSource source(config_);
    std::size_t given = 0;
    while (source.next())
    {
        given++;
        // The first seconds show which sensors there are. A class that taut does not know ends
        // where the next object begins.
        if (written > 250)
        {
            EXPECT_LE(written - foreign, given + 1) << "of " << written;
        }
    }
    EXPECT_EQ(given, 550u);
    EXPECT_FALSE(source.incomplete());
}

TEST_P(GrowingLog, CanBeReadToTheLastObservationWhereTheWriterIsKilled)
{
    RawlogRecorder recorder(config_.path, GetParam());
    for (std::size_t i = 0; i < 300; i++) recorder.write(*observations_[i]);
    const std::string killed = path("killed.rawlog");
    std::filesystem::copy_file(config_.path, killed);  // nothing was closed
    const Content content = readAll(killed);
    EXPECT_EQ(content.imu.size() + content.scans.size(), 300u - 5u);  // five comments
    EXPECT_EQ(content.incomplete, GetParam() > 0);  // without compression no byte is missed
}

TEST_P(GrowingLog, IsNotDamagedWhereItIsLeft)
{
    LogBytes log;
    for (const auto& observation : observations_) log.add(*observation);
    log.bytes().resize(log.bytes().size() - 20);  // the last scan is being written
    writeFile(config_.path, log.bytes());
    config_.wait_for_growth = [] { return LogGrowth::Left; };
    const Content left = readAll(config_);
    EXPECT_EQ(left.scans.size(), 49u);
    EXPECT_FALSE(left.incomplete);
    EXPECT_TRUE(left.warnings.counts().empty());
    config_.wait_for_growth = [] { return LogGrowth::Complete; };
    const Content complete = readAll(config_);
    EXPECT_EQ(complete.scans.size(), 49u);
    EXPECT_TRUE(complete.incomplete);
    EXPECT_EQ(complete.warnings.count("rawlog_truncated"), 1u);
}

TEST_P(GrowingLog, IsNotWaitedForByAReaderThatIsDestroyed)
{
    RawlogRecorder recorder(config_.path, GetParam());
    for (const auto& observation : observations_) recorder.write(*observation);
    config_.wait_for_growth = [&] { return recorder.waitForGrowth(); };
    PrefetchedRawlog log(config_);
    EXPECT_TRUE(log.next());
}

INSTANTIATE_TEST_SUITE_P(Compressed, GrowingLog, testing::Values(0, 1));

class Recorder : public RawlogTest
{
};

TEST_F(Recorder, NeverWritesOverAFile)
{
    writeFile(path("log.rawlog"), {1, 2, 3});
    try
    {
        RawlogRecorder recorder(path("log.rawlog"), 1);
        FAIL() << "it was written over";
    }
    catch (const std::runtime_error& e)
    {
        EXPECT_THAT(e.what(), HasSubstr("log.rawlog' is there already"));
    }
    EXPECT_EQ(readFile(path("log.rawlog")), (Bytes{1, 2, 3}));
}

TEST_F(Recorder, SaysWhatCannotBeWritten)
{
    EXPECT_THROW(RawlogRecorder(path("none/log.rawlog"), 1), std::runtime_error);
    RawlogRecorder recorder(path("log.rawlog"), 1);
    recorder.close();
    recorder.close();
    EXPECT_THROW(recorder.write(mrptImu(kStart)), std::logic_error);
}

class Replay : public RawlogTest
{
};

TEST_F(Replay, GivesTheObservationsWhenSensorsCouldHaveGivenThem)
{
    LogBytes log;
    log.add(mrptImu(kStart)).add(comment(kStart, "hello"));
    log.add(mrptImu(kStart + 90 * kMillisecond)).add(mrptScan(kStart));
    log.add(mrptImu(kStart + 50 * kMillisecond));      // late
    log.add(mrptImu(kStart + 60'000 * kMillisecond));  // a gap is not waited out
    log.add(mrptImu(kStart + 60'010 * kMillisecond));
    log.add(mrptImu(kStart + 10 * kMillisecond));  // the clock was set back
    log.add(mrptImu(kStart + 20 * kMillisecond));
    writeFile(path("a.rawlog"), log.bytes());
    RawlogReplay replay(path("a.rawlog"));
    std::vector<Duration> due;
    while (const auto item = replay.next()) due.push_back((item->due - kStart) / kMillisecond);
    const Duration end = (readAll(path("a.rawlog")).scans.at(0).end - kStart) / kMillisecond;
    ASSERT_GT(end, 90);
    EXPECT_EQ(
        due,
        (std::vector<Duration>{0, 90, end, end, end + 1000, end + 1010, end + 1010, end + 1020}));
    EXPECT_EQ(replay.leftOut(), 1u);
    EXPECT_EQ(replay.damage(), "");
}
}  // namespace taut::test
