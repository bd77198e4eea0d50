#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "simulation_support.h"

using namespace taut;
using namespace taut::simulation;
using ::testing::HasSubstr;

namespace
{
std::vector<std::string> scenarioFiles()
{
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(TAUT_SCENARIOS))
        if (entry.path().extension() == ".yaml") files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

std::string messageOf(const std::vector<std::string>& settings)
{
    try
    {
        ConfigSection section = loadScenarioFile(scenarioFiles().front(), settings);
        readScenario(section);
    }
    catch (const ConfigError& e)
    {
        return e.what();
    }
    return "no error";
}
}  // namespace

TEST(Scenario, EveryFileRunsForASecond)
{
    ASSERT_FALSE(scenarioFiles().empty());
    for (const auto& file : scenarioFiles())
    {
        SCOPED_TRACE(file);
        ConfigSection section = loadScenarioFile(file, {"duration=1"});
        const Simulator simulator(readScenario(section));
        Executor executor(1);
        ASSERT_GT(simulator.sweeps(), 0);
        EXPECT_GT(simulator.sweep(0, executor).scan.points.size(), 3000U);
        EXPECT_GT(simulator.imu().samples.size(), 50U);
    }
}

TEST(Scenario, EveryFileStaysClearOfSurfacesForItsWholeDuration)
{
    for (const auto& file : scenarioFiles())
    {
        SCOPED_TRACE(file);
        ConfigSection section = loadScenarioFile(file, {});
        EXPECT_NO_THROW(Simulator(readScenario(section)));
    }
}

TEST(Scenario, TheRoutesOfTheWorldsForLoopsAreCovered)
{
    for (const auto& [name, laps] : std::map<std::string, double>{
             {"storeys_walk", 1},
             {"halls_walk", 2},
             {"halls_walk_later", 1},
             {"blocks_vehicle", 1},
             {"tunnel_vehicle", 1},
             {"field_walk", 1}})
    {
        SCOPED_TRACE(name);
        ConfigSection section =
            loadScenarioFile(std::string(TAUT_SCENARIOS) + "/" + name + ".yaml", {});
        const Scenario s = readScenario(section);
        const Course course = makeCourse(s.motion, makeWorld(s.world).route, s.duration, s.rest);
        const auto end = std::lower_bound(course.times.begin(), course.times.end(), s.duration);
        const double covered =
            course.lengths[static_cast<std::size_t>(end - course.times.begin())] -
            course.lengths.front();
        EXPECT_GT(covered, laps * course.path.length());
        EXPECT_LT(covered, 1.1 * laps * course.path.length());
    }
}

TEST(Scenario, UnknownKeysAreNamed)
{
    EXPECT_THAT(messageOf({"imu.rat=100"}), HasSubstr("'imu.rat'"));
    EXPECT_THAT(messageOf({"lidar.mount.zz=1"}), HasSubstr("'lidar.mount.zz'"));
    EXPECT_THAT(messageOf({"world.type=field", "world.moved=0.3"}), HasSubstr("'world.moved'"));
    EXPECT_THAT(messageOf({"world.type=halls", "world.distinct=7"}), HasSubstr("'world.distinct'"));
    EXPECT_THAT(messageOf({"world.type=halls", "world.moved=2"}), HasSubstr("'world.moved'"));
    EXPECT_THAT(messageOf({"world.type=blocks", "world.glass=1"}), HasSubstr("'world.glass'"));
    EXPECT_THAT(messageOf({"motion.type=dance"}), HasSubstr("'motion.type'"));
    EXPECT_THAT(messageOf({"imu.rate=fast"}), HasSubstr("'imu.rate'"));
    EXPECT_THAT(messageOf({"imu.rate"}), HasSubstr("key=value"));
    EXPECT_THAT(messageOf({"duration.x=1"}), HasSubstr("duration.x=1"));
}

TEST(Scenario, SettingsOverrideTheFile)
{
    ConfigSection section =
        loadScenarioFile(scenarioFiles().front(), {"imu.rate=123", "lidar.mount.z=0.5", "seed=77"});
    const Scenario s = readScenario(section);
    EXPECT_EQ(s.imu.rate, 123);
    EXPECT_EQ(s.lidar.T_imu_lidar.p.z(), 0.5);
    EXPECT_EQ(s.seed, 77);
}

TEST(Scenario, AMotionThroughAWallIsRefusedWithItsTime)
{
    ConfigSection section = loadScenarioFile(scenarioFiles().front(), {"motion.height=0.1"});
    const Scenario scenario = readScenario(section);
    EXPECT_THROW(Simulator{scenario}, std::runtime_error);
}
