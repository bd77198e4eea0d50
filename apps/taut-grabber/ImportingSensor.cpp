#include "ImportingSensor.h"

#include <mrpt/obs/CObservation.h>

#include "taut/rawlog/toObservation.h"

namespace taut
{
namespace
{
constexpr double kDegree = M_PI / 180;

Pose readPose(const mrpt::config::CConfigFileBase& config, const std::string& section)
{
    const auto number = [&](const char* key) { return config.read_double(section, key, 0); };
    const auto turn = [&](const char* key, const Vector3d& axis)
    { return expSO3(axis * number(key) * kDegree); };
    return {
        turn("pose_yaw", Vector3d::UnitZ()) * turn("pose_pitch", Vector3d::UnitY()) *
            turn("pose_roll", Vector3d::UnitX()),
        {number("pose_x"), number("pose_y"), number("pose_z")}};
}
}  // namespace

void ImportingSensor::loadConfig_sensorSpecific(
    const mrpt::config::CConfigFileBase& config, const std::string& section)
{
    config_.lidar_label = config.read_string(section, "lidar_label", config_.lidar_label);
    config_.imu_label = config.read_string(section, "imu_label", config_.imu_label);
    config_.T_vehicle_imu = readPose(config, section);
}

std::shared_ptr<mrpt::obs::CObservation> ImportingSensor::give(const ImportedItem& item)
{
    auto observation =
        std::visit([this](const auto& i) { return toObservation(i, config_); }, item);
    (std::holds_alternative<ImuSample>(item) ? samples_ : scans_)++;
    appendObservation(observation);
    return observation;
}

WarningSink ImportingSensor::warnings()
{
    return [this](const Warning& w)
    {
        warned_++;
        logStr(mrpt::system::LVL_WARN, w.kind + ": " + w.text);
    };
}
}  // namespace taut
