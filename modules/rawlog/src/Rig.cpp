#include "taut/rawlog/Rig.h"

#include <cmath>

#include "taut/core/Config.h"
#include "taut/core/NameExpression.h"

namespace taut
{
namespace
{
constexpr double kDegree = M_PI / 180;

/** Whether a section is given, and not empty. */
bool given(const YamlNode* node, const std::string& name)
{
    const YamlNode* child = node != nullptr ? node->find(name) : nullptr;
    return child != nullptr && !child->isNull();
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
    NameExpression(section.path() + ": the sensor label", label);
}

void readBeams(ConfigSection& section, BeamCorrections& beams)
{
    section.key("elevation", beams.elevation, {-10, 10}, "deg, added to each ring's");
    section.key("range", beams.range, {-1, 1}, "m, added to each ring's");
    for (double& angle : beams.elevation) angle *= kDegree;
    if (beams.elevation.empty()) beams.elevation.resize(beams.range.size(), 0);
    if (beams.range.empty()) beams.range.resize(beams.elevation.size(), 0);
    if (beams.elevation.size() != beams.range.size())
        throw ConfigError(
            section.path() + ": elevation has " + std::to_string(beams.elevation.size()) +
            " rings, range " + std::to_string(beams.range.size()));
}

void readLidar(ConfigSection& section, const YamlNode* node, LidarRig& lidar)
{
    readLabel(section, lidar.label);
    auto& pose = section.section("pose");
    const Pose T_vehicle_lidar = readPose(pose);
    if (given(node, "pose")) lidar.T_vehicle_lidar = T_vehicle_lidar;
    section.key(
        "clock_offset", lidar.clock_offset, {-10, 10}, "s, added to its stamps: the IMU's clock");
    auto& rows = section.section("row_elevations");
    double first = 0, last = 0;
    rows.key("first", first, {-90, 90}, "deg, of the first row of range images");
    rows.key("last", last, {-90, 90}, "deg, of the last row");
    if (given(node, "row_elevations")) lidar.row_elevations = {first * kDegree, last * kDegree};
    readBeams(section.section("beams"), lidar.beams);
}

void readImu(ConfigSection& section, const YamlNode* node, ImuRig& imu)
{
    readLabel(section, imu.label);
    const Pose T_vehicle_imu = readPose(section.section("pose"));
    if (given(node, "pose")) imu.T_vehicle_imu = T_vehicle_imu;
    section.key("accel_scale", imu.accel_scale, kPositive, "factor to m/s^2");
    section.key("gyro_scale", imu.gyro_scale, kPositive, "factor to rad/s");
    section.key("max_accel", imu.max_accel, kPositive, "m/s^2; samples with more are left out");
    section.key("max_rate", imu.max_rate, kPositive, "rad/s; samples with more are left out");
    auto& noise = section.section("noise");
    ImuNoise n;
    noise.key("gyro", n.gyro, kPositive, "rad/s/sqrt(Hz)");
    noise.key("accel", n.accel, kPositive, "m/s^2/sqrt(Hz)");
    noise.key("gyro_bias_walk", n.gyro_bias_walk, kNotNegative, "rad/s^2/sqrt(Hz)");
    noise.key("accel_bias_walk", n.accel_bias_walk, kNotNegative, "m/s^3/sqrt(Hz)");
    if (given(node, "noise")) imu.noise = n;
}
}  // namespace

namespace
{
Rig rigOf(const YamlNode& node, const std::string& file)
{
    ConfigSection root(node, "", file);
    Rig rig;
    readLidar(root.section("lidar"), node.find("lidar"), rig.lidar);
    readImu(root.section("imu"), node.find("imu"), rig.imu);
    root.rejectUnknown();
    return rig;
}
}  // namespace

Rig parseRig(const std::string& yaml_text, const std::string& name)
{
    return rigOf(parseYaml(yaml_text, name), name);
}

Rig loadRig(const std::string& path)
{
    return rigOf(readYamlFile(path), path);
}
}  // namespace taut
