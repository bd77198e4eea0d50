#include "taut/trajectory/TrajectoryFile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motions.h"
#include "temporary_file.h"

using namespace taut;
using taut::test::TemporaryFile;
using ::testing::HasSubstr;

namespace
{
std::string errorOfTum(const std::string& content)
{
    const TemporaryFile file(content);
    try
    {
        readTum(file.path());
    }
    catch (const std::runtime_error& e)
    {
        return e.what();
    }
    return "no error";
}
}  // namespace

TEST(TrajectoryTime, IsParsedExactlyFromDecimalText)
{
    EXPECT_EQ(parseSeconds("1700000000.123456789"), 1'700'000'000'123'456'789);
    EXPECT_EQ(parseSeconds("1700000000"), 1'700'000'000'000'000'000);
    EXPECT_EQ(parseSeconds("1.700000000123456789e+09"), 1'700'000'000'123'456'789);
    EXPECT_EQ(parseSeconds("1.700000000123456789999e9"), 1'700'000'000'123'456'790);
    EXPECT_EQ(parseSeconds("17e8"), 1'700'000'000'000'000'000);
    EXPECT_EQ(parseSeconds("0.5"), 500'000'000);
    EXPECT_EQ(parseSeconds(".5"), 500'000'000);
    EXPECT_EQ(parseSeconds("5."), 5'000'000'000);
    EXPECT_EQ(parseSeconds("-1.000000001"), -1'000'000'001);
    EXPECT_EQ(parseSeconds("0.0000000004"), 0);
    EXPECT_EQ(parseSeconds("0.0000000005"), 1);
    EXPECT_EQ(parseSeconds("5e-10"), 1);
    EXPECT_EQ(parseSeconds("5e-20"), 0);
}

TEST(TrajectoryTime, RefusesWhatIsNoTime)
{
    for (const char* text :
         {"", ".", "-", "abc", "1.2.3", "1e", "1e+", "1x", "nan", "inf", "1e+-3"})
        EXPECT_THROW(parseSeconds(text), std::invalid_argument) << text;
    EXPECT_THROW(parseSeconds("9300000000"), std::invalid_argument);  // past year 2262
    EXPECT_THROW(parseSeconds("1e900"), std::invalid_argument);
}

TEST(TrajectoryTime, MakesTheRoundTripAtEveryNanosecond)
{
    for (Time t = 1'700'000'000'999'999'990; t < 1'700'000'001'000'000'010; t++)
        EXPECT_EQ(parseSeconds(formatSeconds(t)), t);
    for (const Time t : {Time{0}, Time{1}, Time{-1}, Time{-1'500'000'000}})
        EXPECT_EQ(parseSeconds(formatSeconds(t)), t);
    EXPECT_EQ(formatSeconds(1'700'000'000'000'000'007), "1700000000.000000007");
}

TEST(TumFile, HasTheExpectedBytes)
{
    const TemporaryFile file;
    const Pose T{expSO3({0, 0, M_PI / 2}), {1.5, -2, 0.000000001}};
    writeTum(file.path(), {{1'700'000'000'005'000'000, T}});
    EXPECT_EQ(
        file.content(),
        "# timestamp tx ty tz qx qy qz qw\n"
        "1700000000.005000000 1.500000000 -2.000000000 0.000000001 "
        "0.000000000000 0.000000000000 0.707106781187 0.707106781187\n");
}

TEST(TumFile, MakesTheRoundTrip)
{
    const TemporaryFile file;
    const Trajectory written = test::lissajous(20, 10);
    writeTum(file.path(), written);
    const Trajectory read = readTum(file.path());
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); i++)
    {
        EXPECT_EQ(read[i].t, written[i].t);
        EXPECT_LT((read[i].T_world_imu.p - written[i].T_world_imu.p).norm(), 1e-9);
        EXPECT_LT((read[i].T_world_imu.R - written[i].T_world_imu.R).norm(), 1e-11);
    }
}

TEST(TumFile, IsReadWithCommentsBlankLinesTabsAndForeignLineEnds)
{
    const TemporaryFile file(
        "# a comment\r\n\n  # another\n1.5\t1 2 3  0 0 0 1\r\n\n2.500000000000000000e+00 4 5 6 1 0 "
        "0 0");
    const Trajectory read = readTum(file.path());
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].t, 1'500'000'000);
    EXPECT_EQ(read[0].T_world_imu.p, Vector3d(1, 2, 3));
    EXPECT_EQ(read[1].t, 2'500'000'000);
    EXPECT_LT((read[1].T_world_imu.R - expSO3({M_PI, 0, 0})).norm(), 1e-12);
}

TEST(TumFile, NamesTheLineOfWhatIsMalformed)
{
    EXPECT_THAT(errorOfTum("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n"), HasSubstr(".txt:2: 8 columns"));
    EXPECT_THAT(errorOfTum("# c\n1 0 0 x 0 0 0 1\n"), HasSubstr(".txt:2: 'x' is not a number"));
    EXPECT_THAT(errorOfTum("1 0 0 nan 0 0 0 1\n"), HasSubstr(".txt:1: 'nan' is not finite"));
    EXPECT_THAT(errorOfTum("1 0 0 0 0 0 0 0\n"), HasSubstr(".txt:1: the quaternion has norm 0.0"));
    EXPECT_THAT(errorOfTum("t 0 0 0 0 0 0 1\n"), HasSubstr(".txt:1: 't' is not a time"));
    EXPECT_THAT(
        errorOfTum("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
        HasSubstr(".txt:2: time goes backward, from 2.000000000 to 1.000000000 s"));
    EXPECT_THROW(readTum("/does/not/exist.tum"), std::runtime_error);
}

TEST(TumFile, DropsARepeatedStampWithAWarning)
{
    const TemporaryFile file("1 0 0 0 0 0 0 1\n1 9 9 9 0 0 0 1\n2 0 0 0 0 0 0 1\n");
    std::vector<Warning> warnings;
    const Trajectory read = readTum(file.path(), [&](const Warning& w) { warnings.push_back(w); });
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].T_world_imu.p, Vector3d::Zero());
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].kind, "repeated_stamp");
    EXPECT_EQ(warnings[0].t, 1'000'000'000);
}

TEST(TumFile, LeavesOutACutLastLineWithAWarning)
{
    for (const char* cut : {"3 0 0", "3 0 0 0 0 0 0 -", "3.00 1 2 3 0 0 0 0.", "3 0 0 0 0 0 0 0.1"})
    {
        const TemporaryFile file(std::string("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n") + cut);
        std::vector<Warning> warnings;
        EXPECT_EQ(
            readTum(file.path(), [&](const Warning& w) { warnings.push_back(w); }).size(), 2u);
        ASSERT_EQ(warnings.size(), 1u) << cut;
        EXPECT_EQ(warnings[0].kind, "cut_line");
        EXPECT_THAT(warnings[0].text, HasSubstr(".txt:3: "));
    }
}

TEST(TumFile, HoldsEachPoseAsSoonAsItIsWritten)
{
    const TemporaryFile file;
    TumWriter writer(file.path());
    for (Time t = 1; t < 4; t++)
    {
        writer.write({t, {}});
        EXPECT_EQ(readTum(file.path()).size(), static_cast<std::size_t>(t));
    }
}

TEST(TumFile, NamesTheCauseWhereTheDiskIsFull)
{
    if (!std::ofstream("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    try
    {
        TumWriter writer("/dev/full");
        writer.write({1, {}});
        FAIL();
    }
    catch (const std::runtime_error& e)
    {
        EXPECT_THAT(e.what(), HasSubstr("cannot write '/dev/full': No space left on device"));
    }
}

TEST(TumFile, WriterRefusesTimeThatDoesNotIncrease)
{
    const TemporaryFile file;
    TumWriter writer(file.path());
    writer.write({5, {}});
    EXPECT_THROW(writer.write({5, {}}), std::invalid_argument);
    EXPECT_THROW(writeTum("/does/not/exist.tum", {}), std::runtime_error);
}

TEST(KittiFile, HasTheExpectedBytesAndMakesTheRoundTrip)
{
    const TemporaryFile file;
    const Pose T{expSO3({0, 0, M_PI / 2}).array().round().matrix(), {1.5, -2, 3}};
    writeKitti(file.path(), {Pose{}, T});
    EXPECT_EQ(
        file.content(),
        "1.000000000000 0.000000000000 0.000000000000 0.000000000000 "
        "0.000000000000 1.000000000000 0.000000000000 0.000000000000 "
        "0.000000000000 0.000000000000 1.000000000000 0.000000000000\n"
        "0.000000000000 -1.000000000000 0.000000000000 1.500000000000 "
        "1.000000000000 0.000000000000 0.000000000000 -2.000000000000 "
        "0.000000000000 0.000000000000 1.000000000000 3.000000000000\n");
    const auto read = readKitti(file.path());
    ASSERT_EQ(read.size(), 2u);
    EXPECT_LT((read[1].R - T.R).norm(), 1e-12);
    EXPECT_LT((read[1].p - T.p).norm(), 1e-12);
}

TEST(KittiFile, RefusesWhatIsNoRotation)
{
    const TemporaryFile file("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 -1 0\n");
    try
    {
        readKitti(file.path());
        FAIL();
    }
    catch (const std::runtime_error& e)
    {
        EXPECT_THAT(e.what(), HasSubstr(".txt:2: the left 3x3 part is not a rotation"));
    }
}

TEST(KittiFile, TakesItsStampsFromAFileOfTimes)
{
    const TemporaryFile poses("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 5 0 1 0 0 0 0 1 0\n", "poses.txt");
    const TemporaryFile times("0.000000e+00\n1.037359e-01\n", "times.txt");
    const Trajectory read = readKitti(poses.path(), times.path());
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[1].t, 103'735'900);
    EXPECT_EQ(read[1].T_world_imu.p, Vector3d(5, 0, 0));
    times.write("0\n");
    EXPECT_THROW(readKitti(poses.path(), times.path()), std::runtime_error);
    times.write("1\n1\n");
    EXPECT_THROW(readKitti(poses.path(), times.path()), std::runtime_error);
}

TEST(EurocFile, IsReadWithItsOrderOfTheQuaternionAndWithoutTheOtherColumns)
{
    const TemporaryFile file(
        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
        "q_RS_z [], v_RS_R_x [m s^-1]\n"
        "1403636580838555648,4.5,-1.25,0.5,0.6,0,0.8,0,0.1,0.2\n"
        "1403636580843555328,4.5,-1.5,0.5,1,0,0,0,0.1,0.2\r\n");
    const Trajectory read = readEuroc(file.path());
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].t, 1'403'636'580'838'555'648);
    EXPECT_EQ(read[1].T_world_imu.p, Vector3d(4.5, -1.5, 0.5));
    const Eigen::Quaterniond q(0.6, 0, 0.8, 0);
    EXPECT_LT((read[0].T_world_imu.R - q.toRotationMatrix()).norm(), 1e-12);

    const TemporaryFile in_seconds("1403636580.838,4.5,-1.25,0.5,1,0,0,0\n");
    EXPECT_THROW(readEuroc(in_seconds.path()), std::runtime_error);
}
