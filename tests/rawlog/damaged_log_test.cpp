#include <gmock/gmock.h>

#include "mrpt_support.h"

namespace taut::test
{
using testing::AllOf;
using testing::HasSubstr;

class DamagedLog : public RawlogTest
{
 protected:
    DamagedLog()
    {
        for (int k = 0; k < 4; k++)
        {
            const Time t = kStart + k * 100 * kMillisecond;
            log_.add(mrptImu(t)).add(mrptScan(t));
        }
    }

    std::string error(const std::string& file) const
    {
        try
        {
            readAll(file);
        }
        catch (const std::runtime_error& e)
        {
            return e.what();
        }
        return "";
    }

    /** Reads a file that was cut: gives the number of measurements, each as it was written. */
    std::size_t readCut(const Bytes& bytes, bool& incomplete) const
    {
        writeFile(path("cut.rawlog"), bytes);
        RawlogConfig config;
        config.path = path("cut.rawlog");
        std::size_t given = 0;
        incomplete = true;
        try
        {
            WarningLog warnings;
            RawlogSource source(config, warnings.sink());
            while (const auto measurement = source.next())
            {
                const Time t = kStart + static_cast<Time>(given / 2) * 100 * kMillisecond;
                if (const auto* sample = std::get_if<ImuSample>(&*measurement))
                    EXPECT_EQ(sample->t, t);
                else
                    EXPECT_EQ(std::get<Scan>(*measurement).points.size(), 100u);
                given++;
            }
            incomplete = source.incomplete();
            EXPECT_EQ(warnings.count("rawlog_truncated"), incomplete ? 1u : 0u);
        }
        catch (const std::runtime_error& e)
        {
            EXPECT_THAT(e.what(), HasSubstr("cut.rawlog"));
            EXPECT_LT(given, 2u);  // no rawlog, or no LiDAR in it: nothing to work on
        }
        return given;
    }

    LogBytes log_;
};

TEST_F(DamagedLog, AFileThatCannotBeReadIsAnErrorThatNamesItAndTheCause)
{
    EXPECT_THAT(error(path("none.rawlog")), AllOf(HasSubstr("none.rawlog"), HasSubstr("No such")));
    EXPECT_THAT(error(path(".")), HasSubstr("folder"));
    writeFile(path("empty.rawlog"), {});
    EXPECT_THAT(error(path("empty.rawlog")), AllOf(HasSubstr("empty.rawlog"), HasSubstr("empty")));
    const std::string text = "This is a letter to a friend of mine, and not a rawlog.";
    writeFile(path("text.rawlog"), Bytes(text.begin(), text.end()));
    EXPECT_THAT(error(path("text.rawlog")), HasSubstr("is not a rawlog"));
    writeFile(path("zeros.rawlog"), Bytes(1000));
    EXPECT_THAT(error(path("zeros.rawlog")), HasSubstr("is not a rawlog"));
}

TEST_F(DamagedLog, APlainLogCutAnywhereGivesAllWholeObjectsBeforeTheCut)
{
    const Bytes& all = log_.bytes();
    for (std::size_t size = 1; size < all.size(); size += 23)
    {
        std::size_t whole = 0;
        while (log_.ends()[whole] <= size) whole++;
        const bool at_end_of_object = whole > 0 && log_.ends()[whole - 1] == size;
        bool incomplete = false;
        const auto given = readCut(Bytes(all.begin(), all.begin() + size), incomplete);
        if (whole >= 2)
        {
            EXPECT_EQ(given, whole);
        }
        EXPECT_EQ(incomplete, !at_end_of_object || whole < 2) << "cut at " << size;
    }
}

TEST_F(DamagedLog, ACompressedLogCutAnywhereIsNoticedEvenBetweenTwoObjects)
{
    const auto file = gzopen(path("whole.rawlog").c_str(), "wb1");
    gzwrite(file, log_.bytes().data(), static_cast<unsigned>(log_.bytes().size()));
    gzclose(file);
    const Bytes all = readFile(path("whole.rawlog"));
    bool incomplete = true;
    EXPECT_EQ(readCut(all, incomplete), 8u);
    EXPECT_FALSE(incomplete);
    std::size_t most = 0;
    for (std::size_t size = 1; size < all.size(); size += 7)
    {
        most = std::max(most, readCut(Bytes(all.begin(), all.begin() + size), incomplete));
        EXPECT_TRUE(incomplete) << "cut at " << size << " of " << all.size();
    }
    const auto given = readCut(Bytes(all.begin(), all.end() - 8), incomplete);
    EXPECT_EQ(given, 8u);  // all data there, only the checksum is missing
    EXPECT_TRUE(incomplete);
    EXPECT_GT(most, 4u);
}

TEST_F(DamagedLog, FlippedBitsInACompressedLogAreNoticed)
{
    const auto file = gzopen(path("whole.rawlog").c_str(), "wb1");
    gzwrite(file, log_.bytes().data(), static_cast<unsigned>(log_.bytes().size()));
    gzclose(file);
    const Bytes all = readFile(path("whole.rawlog"));
    for (std::size_t at = 60; at < all.size(); at += 211)
    {
        Bytes damaged = all;
        damaged[at] ^= 0x10;
        writeFile(path("flipped.rawlog"), damaged);
        try
        {
            EXPECT_TRUE(readAll(path("flipped.rawlog")).incomplete) << "flipped at " << at;
        }
        catch (const std::runtime_error&)
        {
            // nothing readable, or a label was hit so that there seem to be two sensors
        }
    }
}

TEST_F(DamagedLog, AnObjectOfAnUnknownClassEndsTheReadingWithItsName)
{
    Bytes bytes = log_.bytes();
    const std::string name = "CObservationVelodyneScan", other = "CObservationVelodyneXcan";
    const auto at =
        std::search(bytes.begin() + log_.ends()[4], bytes.end(), name.begin(), name.end());
    ASSERT_NE(at, bytes.end());
    std::copy(other.begin(), other.end(), at);
    writeFile(path("a.rawlog"), bytes);
    const auto content = readAll(path("a.rawlog"));
    EXPECT_EQ(content.all.size(), 5u);
    EXPECT_TRUE(content.incomplete);
    ASSERT_EQ(content.warnings.count("rawlog_truncated"), 1u);
    EXPECT_THAT(content.warnings.kept()[0].text, HasSubstr(other));
}
}  // namespace taut::test
