/** The capture files of config/grabber are taken by the drivers they name. */
#include <mrpt/config/CConfigFile.h>
#include <mrpt/hwdrivers/registerAllClasses.h>

#include <filesystem>

#include "grabber_support.h"

namespace taut::test
{
namespace
{
TEST(CaptureFiles, AreTakenByTheDriversTheyName)
{
    mrpt::hwdrivers::registerAllClasses_mrpt_hwdrivers();
    std::size_t sensors = 0;
    for (const auto& file : std::filesystem::directory_iterator(TAUT_CONFIG "/grabber"))
    {
        const mrpt::config::CConfigFile config(file.path().string());
        EXPECT_FALSE(config.read_bool("global", "use_sensoryframes", true)) << file.path();
        EXPECT_EQ(config.read_int("global", "GRABBER_PERIOD_MS", 0), 100) << file.path();
        std::vector<std::string> sections;
        config.getAllSections(sections);
        for (const auto& section : sections)
        {
            if (section == "global" || section.empty()) continue;
            SCOPED_TRACE(file.path().string() + " " + section);
            EXPECT_GT(makeSensor(config, section)->getProcessRate(), 0);
            sensors++;
        }
    }
    EXPECT_GE(sensors, 5U);
}
}  // namespace
}  // namespace taut::test
