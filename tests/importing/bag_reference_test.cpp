/** Bags that other programs wrote, see bags/README.md. */
#include "bag_support.h"

namespace taut::test
{
namespace
{
constexpr Time kReferenceStart = 1'700'000'000'123'456'789;

class ReferenceBag : public testing::TestWithParam<const char*>
{
};

/** A sweep as the formulas of the bags have it. */
Scan referenceSweep(int k)
{
    Scan scan;
    scan.stamp = kReferenceStart + k * Duration{100'000'000};
    for (int i = 0; i < 40; i++)
    {
        const auto f = static_cast<float>(i);
        LidarPoint point;
        point.position = {1 + f + 0.25f * static_cast<float>(k), -0.5f * f, 0.125f * f};
        point.intensity = f;
        point.offset = i * 2'500'000;
        point.ring = static_cast<std::uint16_t>(i % 4);
        scan.points.push_back(point);
    }
    scan.end = scan.stamp + scan.points.back().offset;
    return scan;
}

TEST_P(ReferenceBag, GivesWhatItsWriterWasGiven)
{
    const Imported result = import(std::string(TAUT_BAG_DIR "/") + GetParam());
    expectSame(result.scans, {referenceSweep(0), referenceSweep(1), referenceSweep(2)}, 0);
    EXPECT_TRUE(result.warnings.counts().empty());
    ASSERT_EQ(result.readings.size(), 30u);
    for (int i = 0; i < 30; i++)
    {
        const ImuSample& sample = result.readings[static_cast<std::size_t>(i)];
        EXPECT_EQ(sample.t, kReferenceStart + i * Duration{10'000'000});
        EXPECT_EQ(sample.gyro, Vector3d(0.01 * i, -0.02, 0.03));
        EXPECT_EQ(sample.accel, Vector3d(0.1, -0.001 * i, 9.81));
    }
}

INSTANTIATE_TEST_SUITE_P(
    Files, ReferenceBag,
    testing::Values(
        "rosbag_none.bag", "rosbag_bz2.bag", "rosbag_lz4.bag", "mcap_none.mcap", "mcap_zstd.mcap",
        "mcap_livox_zstd.mcap"),
    [](const auto& file)
    {
        std::string name = file.param;
        std::replace(name.begin(), name.end(), '.', '_');
        return name;
    });
}  // namespace
}  // namespace taut::test
