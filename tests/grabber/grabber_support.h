#pragma once

#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/system/os.h>

#include <stdexcept>
#include <string>

namespace taut::test
{
/** A driver, as rawlog-grabber makes one of a section of a capture file. Throws what that does. */
inline mrpt::hwdrivers::CGenericSensor::Ptr makeSensor(
    const mrpt::config::CConfigFileBase& config, const std::string& section)
{
    static const bool loaded = mrpt::system::loadPluginModule(TAUT_GRABBER);
    EXPECT_TRUE(loaded);
    const std::string driver = config.read_string(section, "driver", "", true);
    auto sensor = mrpt::hwdrivers::CGenericSensor::createSensorPtr(driver);
    if (!sensor) throw std::runtime_error("there is no driver " + driver);
    sensor->loadConfig(config, section);
    return sensor;
}
}  // namespace taut::test
