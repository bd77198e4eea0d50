/** Every container gives what was written, and its damages are told. */
#include <ostream>

#include "bag_support.h"

namespace taut::test
{
namespace
{
struct Container
{
    const char* name;
    ContainerStyle style;
    TestWire wire;
    void (*write)(const std::string& path, const TestMessages&, const ContainerStyle&);
};

void PrintTo(const Container& container, std::ostream* out)
{
    *out << container.name;
}

void writeRos1(const std::string& path, const TestMessages& m, const ContainerStyle& style)
{
    writeFile(path, Ros1Writer::bag(m, style));
}
void writeMcap(const std::string& path, const TestMessages& m, const ContainerStyle& style)
{
    writeFile(path, McapWriter::file(m, style));
}
void writeRos1Mcap(const std::string& path, const TestMessages& m, const ContainerStyle& style)
{
    writeFile(path, McapWriter::file(m, style, "ros1"));
}

const std::vector<Container> kContainers{
    {"Ros1", {"", 5, true}, TestWire::Ros1, writeRos1},
    {"Ros1Bz2", {"bz2", 30, true}, TestWire::Ros1, writeRos1},
    {"Ros1Lz4", {"lz4", 30, true}, TestWire::Ros1, writeRos1},
    {"Mcap", {"", 5, true}, TestWire::Cdr, writeMcap},
    {"McapWithoutChunks", {"", 0, true}, TestWire::Cdr, writeMcap},
    {"McapZstd", {"zstd", 30, true}, TestWire::Cdr, writeMcap},
    {"McapLz4", {"lz4", 30, true}, TestWire::Cdr, writeMcap},
    {"McapBigEndian", {"", 5, true}, TestWire::CdrBigEndian, writeMcap},
    {"McapOfRos1", {"", 5, true}, TestWire::Ros1, writeRos1Mcap},
    {"Sqlite3", {}, TestWire::Cdr, writeSqlite3Bag},
    {"Sqlite3ZstdMessages", {"zstd", 1, true}, TestWire::Cdr, writeSqlite3Bag},
};

class BagContainer : public testing::TestWithParam<Container>
{
 protected:
    /** The messages of 12 sweeps with their readings. */
    TestMessages messages() const
    {
        return merged(
            sweepMessages(scans_, {}, GetParam().wire),
            readingMessages(readings_, GetParam().wire));
    }
    std::string write(const TestMessages& m) const
    {
        GetParam().write(folder_ / "log.bag", m, GetParam().style);
        return folder_ / "log.bag";
    }

    TemporaryFolder folder_;
    std::vector<Scan> scans_ = syntheticSweeps(12);
    ImuSamples readings_ = syntheticReadings(12);
};

TEST_P(BagContainer, GivesThePointsAndReadingsThatWereWritten)
{
    const Imported result = import(write(messages()));
    expectSame(result.scans, scans_, 0);
    EXPECT_EQ(result.scans.front().rings, 4);
    ASSERT_EQ(result.readings.size(), readings_.size());
    for (std::size_t i = 0; i < readings_.size(); i++)
    {
        EXPECT_EQ(result.readings[i].t, readings_[i].t);
        EXPECT_EQ(result.readings[i].gyro, readings_[i].gyro);
        EXPECT_EQ(result.readings[i].accel, readings_[i].accel);
    }
    EXPECT_TRUE(result.warnings.counts().empty());
    EXPECT_NEAR(result.progress, 1, 0.2);
}

TEST_P(BagContainer, KeepsOtherTopicsOutOfTheWay)
{
    TestMessages all = messages();
    all.insert(all.begin() + 3, {"/camera", "sensor_msgs/Image", kBagStart, Blob(1000, 7)});
    EXPECT_EQ(import(write(all)).scans.size(), scans_.size());
}

TEST_P(BagContainer, LeavesOutAMessageThatIsNotWhatItsTypeSays)
{
    TestMessages all = messages();
    for (auto& m : all)
        if (m.topic == kLidarTopic)
        {
            m.data.resize(m.data.size() / 2);
            break;
        }
    const Imported result = import(write(all));
    EXPECT_EQ(result.scans.size(), scans_.size() - 1);
    EXPECT_EQ(result.warnings.count("message_invalid"), 1u);
}

TEST_P(BagContainer, ThatWasCutOffGivesWhatIsComplete)
{
    const std::string path = write(messages());
    const Blob whole = readFile(path);
    writeFile(path, Blob(whole.begin(), whole.begin() + static_cast<long>(whole.size() * 6 / 10)));
    const Imported result = import(path);
    EXPECT_GE(result.scans.size(), 3u);
    EXPECT_LT(result.scans.size(), scans_.size());
    EXPECT_GE(result.warnings.count("bag_truncated"), 1u);
    expectSame(result.scans, {scans_.begin(), scans_.begin() + result.scans.size()}, 0);
}

INSTANTIATE_TEST_SUITE_P(
    All, BagContainer, testing::ValuesIn(kContainers), testing::PrintToStringParamName());

TestMessages clouds(const std::vector<Scan>& scans, TestWire wire)
{
    return sweepMessages(scans, {}, wire);
}

TEST(ARos1Bag, WhoseCloudsHaveRowsWithoutPointsIsReadAtOnce)
{
    const TemporaryFolder folder;
    const auto scans = syntheticSweeps(3);
    TestMessages messages = clouds(scans, TestWire::Ros1);
    WireWriter out(TestWire::Ros1);
    out.header(scans.back().end);
    out.number(std::uint32_t{0xffffffff});  // rows: each was gone through
    out.number(std::uint32_t{0});           // width
    out.number(std::uint32_t{3});
    for (const std::string name : {"x", "y", "z"})
    {
        out.text(name);
        out.number(static_cast<std::uint32_t>(4 * (name.front() - 'x')));
        out.number(datatypeOf("float32"));
        out.number(std::uint32_t{1});
    }
    out.number(std::uint8_t{0});
    out.number(std::uint32_t{12});
    out.number(std::uint32_t{0});
    out.bytes({});
    out.number(std::uint8_t{1});
    // Together they took longer than a test may.
    for (int i = 0; i < 500; i++)
        messages.push_back(
            {kLidarTopic, "sensor_msgs/PointCloud2", arrivalOf(scans.back()), out.message()});
    writeFile(folder / "a.bag", Ros1Writer::bag(messages));
    const Imported result = import(folder / "a.bag");
    EXPECT_EQ(result.scans.size(), 3U);
    EXPECT_EQ(result.warnings.count("scan_empty"), 500U);
}

TEST(ARos1Bag, ThatWasNotClosedIsReadAndSaysHowToRepairIt)
{
    const TemporaryFolder folder;
    const auto scans = syntheticSweeps(7);
    writeFile(
        folder / "a.bag.active", Ros1Writer::bag(clouds(scans, TestWire::Ros1), {"lz4", 2, false}));
    const Imported result = import(folder / "a.bag.active");
    expectSame(result.scans, scans, 0);
    ASSERT_EQ(result.warnings.count("bag_unindexed"), 1u);
    EXPECT_THAT(result.warnings.kept().front().text, testing::HasSubstr("rosbag reindex"));
}

TEST(ARos1Bag, ThatEndsBetweenTwoChunksIsNotTakenForAWholeOne)
{
    const TemporaryFolder folder;
    const auto scans = syntheticSweeps(6);
    const Blob whole = Ros1Writer::bag(clouds(scans, TestWire::Ros1), {"", 2, true});
    const Blob half =
        Ros1Writer::bag(clouds({scans.begin(), scans.begin() + 4}, TestWire::Ros1), {"", 2, false});
    writeFile(
        folder / "a.bag", Blob(whole.begin(), whole.begin() + static_cast<long>(half.size())));
    const Imported result = import(folder / "a.bag");
    EXPECT_EQ(result.scans.size(), 4u);
    EXPECT_EQ(result.warnings.count("bag_truncated"), 1u);
}

TEST(ARos1Bag, WithADamagedChunkGivesTheOthers)
{
    const TemporaryFolder folder;
    const auto scans = syntheticSweeps(6);
    Blob bag = Ros1Writer::bag(clouds(scans, TestWire::Ros1), {"bz2", 2, true});
    bag[bag.size() / 2] ^= 0x10;
    writeFile(folder / "a.bag", bag);
    const Imported result = import(folder / "a.bag");
    EXPECT_EQ(result.scans.size(), 4u);
    EXPECT_EQ(result.warnings.count("bag_damaged"), 1u);
}

TEST(ARos1Bag, OfAnOldFormatSaysWhatToDo)
{
    const TemporaryFolder folder;
    const std::string old = "#ROSRECORD V1.2\n and more that is not read";
    writeFile(folder / "old.bag", Blob(old.begin(), old.end()));
    EXPECT_THAT(failure(folder / "old.bag"), testing::HasSubstr("rosbag fix"));
}

TEST(AnMcapFile, WithoutASummaryIsReadAndToldToBeIncomplete)
{
    const TemporaryFolder folder;
    const auto scans = syntheticSweeps(5);
    writeFile(
        folder / "a.mcap", McapWriter::file(clouds(scans, TestWire::Cdr), {"zstd", 2, false}));
    const Imported result = import(folder / "a.mcap");
    expectSame(result.scans, scans, 0);
    EXPECT_EQ(result.warnings.count("bag_truncated"), 1u);
}

TEST(AnMcapFile, WithAWrongChecksumLosesThatChunkAlone)
{
    const TemporaryFolder folder;
    const auto scans = syntheticSweeps(6);
    Blob file = McapWriter::file(clouds(scans, TestWire::Cdr), {"", 2, true});
    file[file.size() / 2] ^= 0x01;
    writeFile(folder / "a.mcap", file);
    const Imported result = import(folder / "a.mcap");
    EXPECT_EQ(result.scans.size(), 4u);
    EXPECT_EQ(result.warnings.count("bag_damaged"), 1u);
    EXPECT_THAT(result.warnings.kept().front().text, testing::HasSubstr("checksum"));
}

TEST(AnMcapFile, OfAnUnknownCompressionFailsWithItsName)
{
    const TemporaryFolder folder;
    Blob file = McapWriter::file(clouds(syntheticSweeps(2), TestWire::Cdr), {"zstd", 1, true});
    const std::string from = "zstd", to = "lzma";
    for (auto at = file.begin();
         (at = std::search(at, file.end(), from.begin(), from.end())) != file.end();)
        std::copy(to.begin(), to.end(), at);
    writeFile(folder / "a.mcap", file);
    WarningLog log;
    const auto open = [&] { openImportSource(folder / "a.mcap", {}, log.sink())->next(); };
    EXPECT_THROW(open(), std::runtime_error);
    ASSERT_GE(log.count("bag_damaged"), 1u);
    EXPECT_THAT(log.kept().front().text, testing::HasSubstr("'lzma' is unknown"));
}

TEST(ASqlite3Bag, WhoseIdentifiersAreAnyIntegersTellsItsProgress)
{
    const TemporaryFolder folder;
    writeSqlite3Bag(folder / "a.db3", clouds(syntheticSweeps(3), TestWire::Cdr));
    sqlite3* db = nullptr;
    sqlite3_open(std::string(folder / "a.db3").c_str(), &db);
    // The difference of the first and the last overflowed.
    ASSERT_EQ(
        sqlite3_exec(
            db,
            "UPDATE messages SET id = CASE id WHEN 1 THEN -9000000000000000000 WHEN 2 THEN 0 "
            "ELSE 9000000000000000000 END",
            nullptr, nullptr, nullptr),
        SQLITE_OK);
    sqlite3_close(db);
    const auto source = openImportSource(folder / "a.db3");
    int scans = 0;
    for (; source->next(); scans++)
    {
        EXPECT_GE(source->progress(), 0);
        EXPECT_LE(source->progress(), 1);
    }
    EXPECT_EQ(scans, 3);
}

TEST(ASqlite3Bag, WhoseMessagesAreComputedIsRefused)
{
    const TemporaryFolder folder;
    writeSqlite3Bag(folder / "a.db3", clouds(syntheticSweeps(1), TestWire::Cdr));
    sqlite3* db = nullptr;
    sqlite3_open(std::string(folder / "a.db3").c_str(), &db);
    ASSERT_EQ(
        sqlite3_exec(
            db,
            "DROP TABLE messages; CREATE VIEW messages AS WITH RECURSIVE m(id) AS (VALUES(1) UNION "
            "ALL SELECT id + 1 FROM m) SELECT id, 1 AS topic_id, 0 AS timestamp, x'' AS data FROM "
            "m",
            nullptr, nullptr, nullptr),
        SQLITE_OK);
    sqlite3_close(db);
    EXPECT_THAT(failure(folder / "a.db3"), testing::HasSubstr("'messages' is no table"));
}

TEST(AFileCompressedAsAWhole, SaysWhatToDo)
{
    const TemporaryFolder folder;
    writeFile(folder / "a.db3.zstd", compress("zstd", Blob(1000, 3)));
    EXPECT_THAT(failure(folder / "a.db3.zstd"), testing::HasSubstr("zstd -d"));
}

/** A bag's folder of three parts with two sweeps each. */
class ABagFolder : public testing::Test
{
 protected:
    void SetUp() override
    {
        std::filesystem::create_directories(folder_ / "bag");
        for (int i = 0; i < 3; i++)
            writeSqlite3Bag(
                part(i),
                clouds({scans_.begin() + 2 * i, scans_.begin() + 2 * i + 2}, TestWire::Cdr));
    }
    std::string part(int i) const
    {
        return folder_ / ("bag/log_" + std::to_string(8 + i) + ".db3");
    }
    void writeMetadata(const std::string& list) const
    {
        std::ofstream(folder_ / "bag/metadata.yaml")
            << "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
            << "  relative_file_paths: " << list << "\n";
    }

    TemporaryFolder folder_;
    std::vector<Scan> scans_ = syntheticSweeps(6);
};

TEST_F(ABagFolder, IsReadInTheOrderOfItsMetadata)
{
    writeMetadata("[log_8.db3, log_9.db3, log_10.db3]");
    const Imported result = import(folder_ / "bag");
    expectSame(result.scans, scans_, 0);
    EXPECT_DOUBLE_EQ(result.progress, 1);
}

TEST_F(ABagFolder, WhoseMetadataNamesTheFolderTooIsReadAsWell)
{
    writeMetadata("[bag/log_8.db3, bag/log_9.db3, bag/log_10.db3]");
    expectSame(import(folder_ / "bag").scans, scans_, 0);
}

TEST_F(ABagFolder, WithoutMetadataIsReadInTheOrderOfTheNumbers)
{
    expectSame(import(folder_ / "bag").scans, scans_, 0);
}

TEST_F(ABagFolder, TellsWhichPartIsMissing)
{
    writeMetadata("[log_8.db3, log_9.db3, log_10.db3]");
    std::filesystem::remove(part(1));
    const Imported result = import(folder_ / "bag");
    EXPECT_EQ(result.scans.size(), 4u);
    ASSERT_EQ(result.warnings.count("bag_file_missing"), 1u);
    EXPECT_THAT(result.warnings.kept().front().text, testing::HasSubstr("log_9.db3"));
}

TEST_F(ABagFolder, IsNoPartOfItself)
{
    writeMetadata("['', ., log_8.db3, log_9.db3, log_10.db3]");  // it was read in itself for ever
    const Imported result = import(folder_ / "bag");
    EXPECT_EQ(result.scans.size(), 6u);
    EXPECT_EQ(result.warnings.count("bag_file_missing"), 2u);
}

TEST_F(ABagFolder, WithBrokenMetadataSaysSo)
{
    std::ofstream(folder_ / "bag/metadata.yaml") << "rosbag2_bagfile_information: {";
    EXPECT_THAT(failure(folder_ / "bag"), testing::HasSubstr("metadata.yaml does not list"));
}
}  // namespace
}  // namespace taut::test
