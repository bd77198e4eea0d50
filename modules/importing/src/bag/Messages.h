#pragma once

#include <string>
#include <vector>

#include "WireReader.h"
#include "taut/core/Geometry.h"
#include "taut/core/Imu.h"

namespace taut::bag
{
/** sensor_msgs/PointField: where a value lies in a point. */
struct PointField
{
    std::string name;
    std::uint32_t offset = 0;   //!< [bytes]
    std::uint8_t datatype = 0;  //!< 1 int8, 2 uint8, 3 int16, 4 uint16, 5 int32, 6 uint32, 7
                                //!< float32, 8 float64
};

/** sensor_msgs/PointCloud2; `data` lies in the message. */
struct PointCloud2
{
    Time stamp = 0;
    std::string frame;  //!< frame_id
    std::uint32_t height = 0, width = 0;
    std::vector<PointField> fields;
    bool big_endian = false;
    std::uint32_t point_step = 0, row_step = 0;  //!< [bytes]
    Bytes data;
};

/** One point of a Livox CustomMsg. */
struct LivoxPoint
{
    std::uint32_t offset_time = 0;  //!< since Livox::timebase [ns]
    float x = 0, y = 0, z = 0;      //!< [m]
    std::uint8_t reflectivity = 0, line = 0;
};

/** CustomMsg of livox_ros_driver, livox_ros_driver2 and livox_interfaces, which are the same. */
struct Livox
{
    Time stamp = 0;
    std::uint64_t timebase = 0;  //!< time of the first point [ns]
    std::uint8_t lidar_id = 0;   //!< of the sensor
    std::vector<LivoxPoint> points;
};

/** One UDP payload of a sensor. */
struct RawPacket
{
    Time stamp = 0;  //!< when the driver took it; 0 if the message does not tell
    Bytes data;      //!< in the message
};

/** geometry_msgs/TransformStamped. */
struct FrameTransform
{
    std::string parent, child;  //!< names of frames
    Vector3d translation = Vector3d::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  //!< of T_parent_child, as told
};

/** True for velodyne_msgs/VelodyneScan, pandar_msgs/PandarScan, nebula_msgs/NebulaPackets, and the
 * PacketMsg of ouster_ros and ouster_sensor_msgs. */
bool isPacketType(const std::string& type);
bool isOusterPacketType(const std::string& type);

/** All throw std::runtime_error if the bytes are no such message. */
/** Of the std_msgs/Header that a message begins with. */
Time readStamp(WireReader reader);
PointCloud2 readPointCloud2(WireReader reader);
Livox readLivox(WireReader reader);
/** The packets of a message of such a type. */
std::vector<RawPacket> readPackets(const std::string& type, WireReader reader);
/** sensor_msgs/Imu, in the units of the message. */
ImuSample readImu(WireReader reader);
/** tf2_msgs/TFMessage or tf/tfMessage. */
std::vector<FrameTransform> readTransforms(WireReader reader);
/** The frame_id of a message that begins with a std_msgs/Header. */
std::string readFrame(WireReader reader);
}  // namespace taut::bag
