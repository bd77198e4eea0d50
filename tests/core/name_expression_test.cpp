#include "taut/core/NameExpression.h"

#include <gmock/gmock.h>

#include "taut/core/Config.h"

using namespace taut;
using testing::HasSubstr;

namespace
{
std::string refusalOf(const std::string& expression)
{
    try
    {
        const NameExpression compiled("--lidar", expression);
    }
    catch (const ConfigError& e)
    {
        return e.what();
    }
    return "";
}
}  // namespace

TEST(NameExpression, MatchesWholeNames)
{
    EXPECT_TRUE(NameExpression("--lidar", "").matches("anything"));
    const NameExpression velodyne("--lidar", "VELO.*_\\d{2,4}");
    EXPECT_TRUE(velodyne.matches("VELODYNE_12"));
    EXPECT_FALSE(velodyne.matches("A VELODYNE_12"));
    EXPECT_TRUE(NameExpression("--imu", "XSENS\\.12345678").matches("XSENS.12345678"));
}

TEST(NameExpression, RefusesWhatIsNoneOrWouldNotEndWell)
{
    EXPECT_THAT(refusalOf("VELO("), HasSubstr("--lidar 'VELO(' is not a regular expression"));
    // The numbers overflowed an int.
    EXPECT_THAT(refusalOf("(a)\\66666666666"), HasSubstr("4 digits"));
    EXPECT_THAT(refusalOf("a{1,99999999999}"), HasSubstr("4 digits"));
    // Each parenthesis took some hundred bytes of the stack.
    EXPECT_THAT(refusalOf(std::string(500'000, '(')), HasSubstr("1000 characters"));
}

TEST(NameExpression, MatchesNoNameThatIsTooLongForTheStack)
{
    const std::string name(1'000'000, 'a');
    EXPECT_FALSE(NameExpression("--lidar", ".*").matches(name));
    EXPECT_TRUE(NameExpression("--lidar", "").matches(name));
    EXPECT_TRUE(NameExpression("--lidar", ".*").matches(name.substr(0, 1000)));
}
