#include "SensorSource.h"

#include <mrpt/config/CConfigFile.h>
#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/obs/CObservation.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "../taut-grabber/EndOfReplay.h"
#include "taut/core/Yaml.h"

namespace taut
{
namespace
{
using mrpt::hwdrivers::CGenericSensor;

constexpr auto kNap = std::chrono::milliseconds(20);
constexpr const char* kGlobal = "global";
}  // namespace

SensorSource::SensorSource(const std::string& path)
{
    if (!std::filesystem::is_regular_file(path))
        throw ConfigError("'" + path + "' is not a file that can be read");
    config_ = std::make_unique<mrpt::config::CConfigFile>(path);
    std::vector<std::string> sections;
    config_->getAllSections(sections);
    for (const std::string& section : sections)
        if (section != kGlobal && config_->keyExists(section, "driver"))
            sections_.push_back(section);
    if (sections_.empty())
        throw ConfigError("'" + path + "' has no section with a driver: no sensor");
    gz_level_ = config_->read_int(kGlobal, "rawlog_GZ_compress_level", gz_level_);
    launch_pause_ms_ = config_->read_int(kGlobal, "time_between_launches", launch_pause_ms_);
    if (gz_level_ < 0 || gz_level_ > 9)
        throw ConfigError("'" + path + "': rawlog_GZ_compress_level is not 0 to 9");
}

SensorSource::~SensorSource()
{
    stop();
}

void SensorSource::start(Sink sink)
{
    for (const std::string& section : sections_)
    {
        if (ending() || stop_) return;
        threads_.emplace_back(
            [this, section, sink]
            {
                const std::string name = "sensor [" + section + "]: ";
                try
                {
                    run(section, sink);
                }
                catch (const EndOfReplay& e)
                {
                    end({e.whole ? Ending::How::Whole : Ending::How::Partly, name + e.what()});
                }
                catch (const std::exception& e)
                {
                    end({Ending::How::Failed, name + e.what()});
                }
            });
        if (section != sections_.back()) pause(std::chrono::milliseconds(launch_pause_ms_));
    }
}

void SensorSource::run(const std::string& section, const Sink& sink)
{
    const std::string driver = config_->read_string(section, "driver", "");
    const CGenericSensor::Ptr sensor = CGenericSensor::createSensorPtr(driver);
    if (!sensor)
        throw std::runtime_error("there is no driver '" + driver + "'; is a plug-in missing (-p)?");
    sensor->loadConfig(*config_, section);
    sensor->initialize();
    const std::chrono::duration<double> period(1 / std::max(1e-3, sensor->getProcessRate()));
    while (!stop_)
    {
        const auto begin = Clock::now();
        sensor->doProcess();
        CGenericSensor::TListObservations given;
        sensor->getObservations(given);
        const auto now = Clock::now();
        for (const auto& [stamp, object] : given)
            if (const auto* o = dynamic_cast<const mrpt::obs::CObservation*>(object.get()))
                sink(*o, now);
        if (sensor->getState() == CGenericSensor::ssError)
            throw std::runtime_error("the driver '" + driver + "' says that it has failed");
        pause(period - (Clock::now() - begin));
    }
}

void SensorSource::pause(std::chrono::duration<double> time) const
{
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
    while (!stop_ && Clock::now() < end)
        std::this_thread::sleep_for(std::min<Clock::duration>(kNap, end - Clock::now()));
}

void SensorSource::end(Ending ending)
{
    const std::lock_guard lock(mutex_);
    if (!ending_) ending_ = std::move(ending);
}

void SensorSource::stop()
{
    stop_ = true;
    for (std::thread& thread : threads_)
        if (thread.joinable()) thread.join();
}

std::optional<ObservationSource::Ending> SensorSource::ending() const
{
    const std::lock_guard lock(mutex_);
    return ending_;
}
}  // namespace taut
