/** Damaged bags end in an error or in warnings, never otherwise. */
#include <optional>
#include <ostream>

#include "bag_support.h"

namespace taut::test
{
namespace
{
struct Target
{
    const char* name;
    Blob (*make)(const TemporaryFolder& folder);
};

void PrintTo(const Target& target, std::ostream* out)
{
    *out << target.name;
}

TestMessages content(TestWire wire)
{
    auto messages = merged(
        sweepMessages(syntheticSweeps(3, 20), {}, wire),
        readingMessages(syntheticReadings(3), wire));
    return messages;
}

Blob sqlite3Bag(const TemporaryFolder& folder)
{
    writeSqlite3Bag(folder / "a.db3", content(TestWire::Cdr));
    return readFile(folder / "a.db3");
}

const std::vector<Target> kTargets{
    {"Ros1", [](const TemporaryFolder&) { return Ros1Writer::bag(content(TestWire::Ros1)); }},
    {"Ros1Bz2",
     [](const TemporaryFolder&) {
         return Ros1Writer::bag(content(TestWire::Ros1), {"bz2", 5, true});
     }},
    {"Ros1Lz4",
     [](const TemporaryFolder&) {
         return Ros1Writer::bag(content(TestWire::Ros1), {"lz4", 5, true});
     }},
    {"Mcap",
     [](const TemporaryFolder&) {
         return McapWriter::file(content(TestWire::Cdr), {"", 0, true});
     }},
    {"McapZstd",
     [](const TemporaryFolder&) {
         return McapWriter::file(content(TestWire::Cdr), {"zstd", 5, true});
     }},
    {"Sqlite3", sqlite3Bag},
};

class DamagedBag : public testing::TestWithParam<Target>
{
 protected:
    /** What it gives, or nothing if it fails; any other end would be a crash or a hang. */
    std::optional<Imported> readDamaged(const Blob& blob)
    {
        writeFile(folder_ / "damaged", blob);
        try
        {
            Imported result = import(folder_ / "damaged");
            for (const Scan& scan : result.scans)
                for (const LidarPoint& point : scan.points)
                    EXPECT_TRUE(point.position.allFinite() && point.offset >= 0);
            read_++;
            return result;
        }
        catch (const std::runtime_error& e)
        {
            EXPECT_NE(std::string(e.what()), "");
            return {};
        }
    }

    TemporaryFolder folder_;
    int read_ = 0;
};

TEST_P(DamagedBag, CutOffAnywhereNeitherCrashesNorLooksComplete)
{
    const Blob whole = GetParam().make(folder_);
    Random random(1);
    for (int i = 0; i < 60; i++)
    {
        const auto length = static_cast<long>(random.uniform(1, static_cast<double>(whole.size())));
        const auto result = readDamaged({whole.begin(), whole.begin() + length});
        if (result && (result->scans.size() < 3 || result->readings.size() < 30))
        {
            EXPECT_FALSE(result->warnings.counts().empty()) << length << " of " << whole.size();
        }
    }
    EXPECT_GT(read_, 5);
}

TEST_P(DamagedBag, WithFlippedBitsDoesNotCrash)
{
    const Blob whole = GetParam().make(folder_);
    Random random(2);
    for (int i = 0; i < 150; i++)
    {
        Blob damaged = whole;
        for (int k = 0; k < 1 + i % 8; k++)
        {
            // Half of them at the beginning and the end, where the structure is.
            double at = random.uniform(0, 1);
            if (k % 2 == 1) at = at < 0.5 ? 0.02 * at : 1 - 0.02 * (1 - at);
            damaged[static_cast<std::size_t>(at * static_cast<double>(whole.size() - 1))] ^=
                static_cast<std::uint8_t>(1 << static_cast<int>(random.uniform(0, 8)));
        }
        readDamaged(damaged);
    }
    EXPECT_GT(read_, 20);
}

INSTANTIATE_TEST_SUITE_P(
    Containers, DamagedBag, testing::ValuesIn(kTargets), testing::PrintToStringParamName());

/** Messages alone, without a container's checks around them. */
TEST(DamagedMessages, DoNotCrash)
{
    const TemporaryFolder folder;
    const auto scans = syntheticSweeps(3, 20);
    Random random(3);
    for (const auto wire : {TestWire::Ros1, TestWire::Cdr})
        for (int i = 0; i < 200; i++)
        {
            auto messages = i % 2 == 0 ? content(wire) : TestMessages();
            if (i % 2 == 1)
                for (const Scan& scan : scans)
                    messages.push_back(
                        {"/livox/lidar", "livox_ros_driver/CustomMsg", arrivalOf(scan),
                         livoxMessage(scan, wire)});
            for (auto& m : messages)
                for (int k = 0; k < 3; k++)
                {
                    const double span = k == 0 ? static_cast<double>(m.data.size()) : 250.0;
                    const auto at =
                        static_cast<std::size_t>(random.uniform(0, span)) % m.data.size();
                    m.data[at] = static_cast<std::uint8_t>(random.uniform(0, 256));
                }
            writeFile(
                folder / "a",
                wire == TestWire::Ros1 ? Ros1Writer::bag(messages) : McapWriter::file(messages));
            try
            {
                import(folder / "a");
            }
            catch (const std::runtime_error&)  // no usable sweep left
            {
            }
        }
}
}  // namespace
}  // namespace taut::test
