#include <gmock/gmock.h>

#include "recording.h"
#include "taut/inspection/RotationCheck.h"
#include "taut/odometry/registerAll.h"

namespace
{
using namespace taut;
using namespace taut::test;

std::vector<std::string> kindsOf(const Findings& findings)
{
    std::vector<std::string> kinds;
    for (const Finding& f : findings) kinds.push_back(f.kind);
    return kinds;
}

/** The same recording for all, made once: 6 s of motion. */
class RotationCheck : public testing::Test
{
 protected:
    static void SetUpTestSuite()
    {
        registerAll();
        Recording recording;
        recording.rest = 0;
        recording.duration = 6;
        recording.columns = 120;
        scans_ = recording.scans();
        imu_ = recording.imu();
    }

    static RotationFacts compare(const std::vector<Scan>& scans, const ImuSamples& imu)
    {
        Executor executor(1);
        return compareRotations(scans, imu, executor);
    }

    static ImuSamples shifted(double offset)
    {
        ImuSamples imu = imu_;
        for (ImuSample& s : imu) s.t += fromSeconds(offset);
        return imu;
    }

    static std::vector<Scan> rotated(const Vector3d& turn)
    {
        std::vector<Scan> scans = scans_;
        for (Scan& s : scans) s.T_imu_lidar.R = s.T_imu_lidar.R * expSO3(turn);
        return scans;
    }

    static inline std::vector<Scan> scans_;
    static inline ImuSamples imu_;
};

TEST_F(RotationCheck, FindsNothingWhereNothingIsWrong)
{
    const RotationFacts f = compare(scans_, imu_);
    EXPECT_EQ(f.not_estimated, "");
    EXPECT_TRUE(f.offset_known);
    EXPECT_TRUE(f.rotation_known);
    EXPECT_NEAR(f.alignment.clock_offset, 0, 1e-3);
    EXPECT_LT(f.angle, 0.0175);
    EXPECT_THAT(kindsOf(findingsOf(f)), testing::IsEmpty());
}

TEST_F(RotationCheck, FindsAClockOffset)
{
    for (const double offset : {0.005, -0.025})
    {
        RotationFacts f = compare(scans_, shifted(offset));
        EXPECT_NEAR(f.alignment.clock_offset, offset, 1e-3);
        f.applied_offset = 0.1;
        const Findings found = findingsOf(f);
        ASSERT_THAT(kindsOf(found), testing::ElementsAre("clock_offset"));
        EXPECT_NEAR(found[0].value, offset, 1e-3);
        EXPECT_THAT(found[0].advice, testing::HasSubstr(offset > 0 ? ": 0.10" : ": 0.07"));
    }
}

TEST_F(RotationCheck, FindsALidarThatIsMountedOtherwise)
{
    const RotationFacts f = compare(rotated({0.03, -0.05, 0.02}), imu_);
    const Findings found = findingsOf(f);
    ASSERT_THAT(kindsOf(found), testing::ElementsAre("extrinsic_rotation"));
    EXPECT_NEAR(found[0].value, 3.53, 0.4);  // degrees
    EXPECT_LT(logSO3(f.alignment.R_imu_lidar.transpose() * scans_[0].T_imu_lidar.R).norm(), 0.01);
}

TEST_F(RotationCheck, FindsRatesInDegrees)
{
    ImuSamples imu = shifted(0.01);
    for (ImuSample& s : imu) s.gyro *= 180 / M_PI;
    const RotationFacts f = compare(scans_, imu);
    EXPECT_NEAR(f.gyro_factor, M_PI / 180, 1e-12);
    EXPECT_NEAR(f.alignment.clock_offset, 0.01, 1e-3);
}

TEST_F(RotationCheck, FindsAGyroThatHasNothingToDoWithTheLidar)
{
    ImuSamples imu = imu_;
    double u = 0;
    for (ImuSample& sample : imu)
    {
        sample.gyro = {std::sin(11 * u), std::cos(17 * u), std::sin(5 * u)};
        u += 0.01;
    }
    const RotationFacts f = compare(scans_, imu);
    EXPECT_NE(f.not_estimated, "");
    EXPECT_THAT(kindsOf(findingsOf(f)), testing::ElementsAre("rotation_mismatch"));
}

TEST(ABodyThatHardlyTurns, LeavesClockAndMountingOpen)
{
    registerAll();
    Recording recording;
    recording.swing = 0;
    recording.columns = 180;
    Executor executor(1);
    const RotationFacts f = compareRotations(recording.scans(), recording.imu(), executor);
    EXPECT_THAT(f.not_estimated, testing::HasSubstr("hardly turns"));
    EXPECT_FALSE(f.offset_known);
    EXPECT_FALSE(f.rotation_known);
    EXPECT_THAT(kindsOf(findingsOf(f)), testing::IsEmpty());
    EXPECT_NE(compareRotations({}, {}, executor).not_estimated, "");
}
}  // namespace
