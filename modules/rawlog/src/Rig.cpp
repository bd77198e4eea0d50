#include "taut/rawlog/Rig.h"

#include <mrpt/containers/yaml.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "ErrorText.h"
#include "LabelExpression.h"
#include "taut/core/Config.h"

namespace taut
{
namespace
{
using mrpt::containers::yaml;

constexpr double kDegree = M_PI / 180;

yaml childOf(const yaml& node, const std::string& name)
{
    return node.isMap() && node.has(name) ? node[name] : yaml();
}

bool given(const yaml& node)
{
    return !node.isNullNode();
}

Pose readPose(ConfigSection& section)
{
    Pose pose;
    section.key("x", pose.p.x(), kAnyNumber, "m, forward");
    section.key("y", pose.p.y(), kAnyNumber, "m, left");
    section.key("z", pose.p.z(), kAnyNumber, "m, up");
    double yaw = 0, pitch = 0, roll = 0;
    section.key("yaw", yaw, {-360, 360}, "deg, about z, applied last");
    section.key("pitch", pitch, {-360, 360}, "deg, about y");
    section.key("roll", roll, {-360, 360}, "deg, about x, applied first");
    pose.R = expSO3(Vector3d::UnitZ() * yaw * kDegree) *
             expSO3(Vector3d::UnitY() * pitch * kDegree) *
             expSO3(Vector3d::UnitX() * roll * kDegree);
    return pose;
}

void readLabel(ConfigSection& section, std::string& label)
{
    section.key("label", label, "regular expression of the sensor's label; empty = any");
    labelExpression(label);  // throws if it is none
}

void readLidar(ConfigSection& section, const yaml& node, LidarRig& lidar)
{
    readLabel(section, lidar.label);
    auto& pose = section.section("pose");
    const Pose T_vehicle_lidar = readPose(pose);
    if (given(childOf(node, "pose"))) lidar.T_vehicle_lidar = T_vehicle_lidar;
    section.key(
        "clock_offset", lidar.clock_offset, {-10, 10}, "s, added to its stamps: the IMU's clock");
    auto& rows = section.section("row_elevations");
    double first = 0, last = 0;
    rows.key("first", first, {-90, 90}, "deg, of the first row of range images");
    rows.key("last", last, {-90, 90}, "deg, of the last row");
    if (given(childOf(node, "row_elevations")))
        lidar.row_elevations = {first * kDegree, last * kDegree};
}

void readImu(ConfigSection& section, const yaml& node, ImuRig& imu)
{
    readLabel(section, imu.label);
    const Pose T_vehicle_imu = readPose(section.section("pose"));
    if (given(childOf(node, "pose"))) imu.T_vehicle_imu = T_vehicle_imu;
    section.key("accel_scale", imu.accel_scale, kPositive, "factor to m/s^2");
    section.key("gyro_scale", imu.gyro_scale, kPositive, "factor to rad/s");
    auto& noise = section.section("noise");
    ImuNoise n;
    noise.key("gyro", n.gyro, kPositive, "rad/s/sqrt(Hz)");
    noise.key("accel", n.accel, kPositive, "m/s^2/sqrt(Hz)");
    noise.key("gyro_bias_walk", n.gyro_bias_walk, kNotNegative, "rad/s^2/sqrt(Hz)");
    noise.key("accel_bias_walk", n.accel_bias_walk, kNotNegative, "m/s^3/sqrt(Hz)");
    if (given(childOf(node, "noise"))) imu.noise = n;
}
}  // namespace

Rig parseRig(const std::string& yaml_text, const std::string& name)
{
    try
    {
        const auto node = yaml::FromText(yaml_text);
        ConfigSection root(node);
        Rig rig;
        readLidar(root.section("lidar"), childOf(node, "lidar"), rig.lidar);
        readImu(root.section("imu"), childOf(node, "imu"), rig.imu);
        root.rejectUnknown();
        return rig;
    }
    catch (const std::exception& e)
    {
        throw ConfigError("rig file '" + name + "': " + errorText(e));
    }
}

Rig loadRig(const std::string& path)
{
    std::ifstream file(path);
    std::ostringstream text;
    if (!file || !(text << file.rdbuf())) throw ConfigError("cannot read rig file '" + path + "'");
    return parseRig(text.str(), path);
}
}  // namespace taut
