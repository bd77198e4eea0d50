#include <ostream>

#include "rawlog_support.h"

namespace taut::test
{
struct Recording
{
    const char* file;
    std::size_t scans, imu_samples, points;
    int rings;
};

void PrintTo(const Recording& recording, std::ostream* out)
{
    *out << recording.file;
}

class Recordings : public testing::TestWithParam<Recording>
{
};

TEST_P(Recordings, AreReadToTheEndWithoutAWarning)
{
    const Recording expected = GetParam();
    RawlogConfig config;
    config.path = (dataFolder() / expected.file).string();
    if (!std::filesystem::exists(config.path)) return skipWithout(GetParam().file);
    WarningLog warnings;
    RawlogSource source(config, warnings.sink());
    std::size_t points = 0;
    int rings = 0;
    while (const auto measurement = source.next())
        if (const auto* scan = std::get_if<Scan>(&*measurement))
        {
            points += scan->points.size();
            rings = std::max(rings, scan->rings);
        }
    EXPECT_EQ(source.progress().scans, expected.scans);
    EXPECT_EQ(source.progress().imu_samples, expected.imu_samples);
    EXPECT_EQ(points, expected.points);
    EXPECT_EQ(rings, expected.rings);
    EXPECT_EQ(source.progress().skipped, 0u);
    EXPECT_FALSE(source.incomplete());
    for (const auto& w : warnings.kept()) ADD_FAILURE() << w.kind << ": " << w.text;
}

INSTANTIATE_TEST_SUITE_P(
    All, Recordings,
    testing::Values(
        Recording{"hall_violent.rawlog", 450, 9021, 4320000, 16},
        Recording{"handheld_real_imu.rawlog", 449, 12858, 7325618, 32},
        Recording{"street_hdl64.rawlog", 20, 0, 2406402, 64},
        Recording{"tripod_vlp16_imu.rawlog", 101, 1748, 1420387, 16}),
    [](const auto& param)
    {
        const std::string file = param.param.file;
        return file.substr(0, file.find('.'));
    });
}  // namespace taut::test
