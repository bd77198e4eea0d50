#include "taut/rawlog/PrefetchedRawlog.h"

#include "mrpt_support.h"

namespace taut::test
{
namespace
{
/** All that a reader says, as text, in its order. */
template <class Reader>
std::string transcript(const RawlogConfig& config)
{
    std::string text;
    const auto warn = [&text](const Warning& w) { text += "! " + w.kind + " " + w.text + "\n"; };
    try
    {
        Reader reader(config, warn);
        while (const auto measurement = reader.next())
        {
            if (const auto* sample = std::get_if<ImuSample>(&*measurement))
                text += "imu " + std::to_string(sample->t);
            else
                text += "scan " + std::to_string(std::get<Scan>(*measurement).end);
            text += " " + std::to_string(reader.progress().scans) + " " +
                    std::to_string(reader.progress().bytes_read) + "\n";
        }
        text += reader.incomplete() ? "incomplete" : "complete";
    }
    catch (const std::runtime_error& e)
    {
        text += e.what();
    }
    return text;
}

}  // namespace

class PrefetchedLog : public RawlogTest
{
 protected:
    /** Scans and an IMU whose time steps back now and then. */
    PrefetchedLog()
    {
        for (int k = 0; k < 60; k++)
        {
            const Time t = kStart + k * 100 * kMillisecond;
            for (int i = 0; i < 10; i++) log_.add(mrptImu(t + i * 10 * kMillisecond));
            if (k % 7 == 3) log_.add(mrptImu(t));
            log_.add(mrptScan(t));
        }
        config_.path = path("a.rawlog");
        save();
    }
    void save() const { writeFile(config_.path, log_.bytes()); }

    LogBytes log_;
    RawlogConfig config_;
};

TEST_F(PrefetchedLog, GivesTheSameMeasurementsAndWarningsInTheSameOrder)
{
    const auto direct = transcript<RawlogSource>(config_);
    EXPECT_NE(direct.find("! imu_time"), std::string::npos);
    EXPECT_EQ(transcript<PrefetchedRawlog>(config_), direct);
}

TEST_F(PrefetchedLog, TellsADamagedEnd)
{
    log_.bytes().resize(log_.bytes().size() - 10);
    save();
    const auto text = transcript<PrefetchedRawlog>(config_);
    EXPECT_EQ(text, transcript<RawlogSource>(config_));
    EXPECT_NE(text.find("incomplete"), std::string::npos);
}

TEST_F(PrefetchedLog, PassesErrorsOnWhereTheyHappen)
{
    log_.add(mrptScan(kStart + 6000 * kMillisecond, "OTHER"));
    save();
    const auto text = transcript<PrefetchedRawlog>(config_);
    EXPECT_EQ(text, transcript<RawlogSource>(config_));
    EXPECT_NE(text.find("--lidar"), std::string::npos);
    std::filesystem::remove(config_.path);
    EXPECT_THROW(PrefetchedRawlog{config_}, std::runtime_error);
}

TEST_F(PrefetchedLog, StopsWhereverItIsLeft)
{
    for (int n = 0; n < 40; n++)
    {
        PrefetchedRawlog reader(config_, {}, 1);
        for (int i = 0; i < n; i++) EXPECT_TRUE(reader.next());
    }
}

TEST_F(PrefetchedLog, StaysAtTheEnd)
{
    PrefetchedRawlog reader(config_);
    while (reader.next())
    {
    }
    EXPECT_FALSE(reader.next());
    EXPECT_FALSE(reader.next());
}
}  // namespace taut::test
