#include "Messages.h"

namespace taut::bag
{
namespace
{
constexpr std::size_t kVelodyneBytes = 1206, kPandarBytes = 1500;  // of a packet's field

Time readTime(WireReader& reader)
{
    // Unsigned in ROS 1, signed in ROS 2: the same until 2038.
    const Time seconds = reader.wire() == Wire::Ros1 ? Time{reader.number<std::uint32_t>()}
                                                     : Time{reader.number<std::int32_t>()};
    const Time nanoseconds = reader.number<std::uint32_t>();
    if (nanoseconds >= 1'000'000'000) throw std::runtime_error("its stamp is not a time");
    return seconds * 1'000'000'000 + nanoseconds;
}

/** std_msgs/Header. */
struct Header
{
    Time stamp = 0;
    std::string frame;
};

Header readHeader(WireReader& reader)
{
    if (reader.wire() == Wire::Ros1) reader.number<std::uint32_t>();  // seq
    Header header;
    header.stamp = readTime(reader);
    header.frame = reader.text();
    return header;
}

RawPacket readVelodynePacket(WireReader& reader)
{
    const Time stamp = readTime(reader);
    return {stamp, reader.array(kVelodyneBytes)};
}

RawPacket readPandarPacket(WireReader& reader)
{
    const Time stamp = readTime(reader);
    const Bytes field = reader.array(kPandarBytes);
    const std::size_t size = reader.number<std::uint32_t>();
    if (size > field.size)
        throw std::runtime_error(
            "a packet says that it has " + std::to_string(size) + " bytes in a field of " +
            std::to_string(field.size));
    return {stamp, {field.data, size}};
}

RawPacket readNebulaPacket(WireReader& reader)
{
    const Time stamp = readTime(reader);
    return {stamp, reader.bytes()};
}

/** How one packet of a message lies in it. */
struct PacketType
{
    const char* name;
    std::size_t smallest;  // bytes
    RawPacket (*read)(WireReader& reader);
};

const PacketType* findPacketType(const std::string& type)
{
    static const PacketType types[] = {
        {"velodyne_msgs/VelodyneScan", 8 + kVelodyneBytes, readVelodynePacket},
        {"pandar_msgs/PandarScan", 8 + kPandarBytes + 4, readPandarPacket},
        {"nebula_msgs/NebulaPackets", 8 + 4, readNebulaPacket}};
    for (const PacketType& known : types)
        if (type == known.name) return &known;
    return nullptr;
}

Vector3d readVector(WireReader& reader)
{
    Vector3d v;
    for (int i = 0; i < 3; i++) v[i] = reader.number<double>();
    return v;
}

void skipNumbers(WireReader& reader, int count)
{
    for (int i = 0; i < count; i++) reader.number<double>();
}
}  // namespace

Time readStamp(WireReader reader)
{
    return readHeader(reader).stamp;
}

PointCloud2 readPointCloud2(WireReader reader)
{
    PointCloud2 cloud;
    const Header header = readHeader(reader);
    cloud.stamp = header.stamp;
    cloud.frame = header.frame;
    cloud.height = reader.number<std::uint32_t>();
    cloud.width = reader.number<std::uint32_t>();
    cloud.fields.resize(reader.sequence(13));
    for (auto& field : cloud.fields)
    {
        field.name = reader.text();
        field.offset = reader.number<std::uint32_t>();
        field.datatype = reader.number<std::uint8_t>();
        reader.number<std::uint32_t>();  // count: only the first element of a field is used
    }
    cloud.big_endian = reader.number<std::uint8_t>() != 0;
    cloud.point_step = reader.number<std::uint32_t>();
    cloud.row_step = reader.number<std::uint32_t>();
    cloud.data = reader.bytes();
    return cloud;  // is_dense says nothing that the points do not
}

Livox readLivox(WireReader reader)
{
    Livox sweep;
    sweep.stamp = readHeader(reader).stamp;
    sweep.timebase = reader.number<std::uint64_t>();
    reader.number<std::uint32_t>();  // point_num: the sequence knows
    sweep.lidar_id = reader.number<std::uint8_t>();
    for (int i = 0; i < 3; i++) reader.number<std::uint8_t>();  // rsvd
    sweep.points.resize(reader.sequence(19));
    for (auto& point : sweep.points)
    {
        point.offset_time = reader.number<std::uint32_t>();
        point.x = reader.number<float>();
        point.y = reader.number<float>();
        point.z = reader.number<float>();
        point.reflectivity = reader.number<std::uint8_t>();
        reader.number<std::uint8_t>();  // tag
        point.line = reader.number<std::uint8_t>();
    }
    return sweep;
}

bool isOusterPacketType(const std::string& type)
{
    return type == "ouster_ros/PacketMsg" || type == "ouster_sensor_msgs/PacketMsg";
}

bool isPacketType(const std::string& type)
{
    return isOusterPacketType(type) || findPacketType(type) != nullptr;
}

std::vector<RawPacket> readPackets(const std::string& type, WireReader reader)
{
    if (isOusterPacketType(type)) return {{0, reader.bytes()}};
    const PacketType* known = findPacketType(type);
    if (known == nullptr) throw std::logic_error(type + " holds no packets");
    readHeader(reader);
    std::vector<RawPacket> packets(reader.sequence(known->smallest));
    for (RawPacket& packet : packets) packet = known->read(reader);
    return packets;
}

ImuSample readImu(WireReader reader)
{
    ImuSample sample;
    sample.t = readHeader(reader).stamp;
    skipNumbers(reader, 4 + 9);  // orientation and its covariance
    sample.gyro = readVector(reader);
    skipNumbers(reader, 9);
    sample.accel = readVector(reader);
    return sample;
}

std::vector<FrameTransform> readTransforms(WireReader reader)
{
    constexpr std::size_t kSmallest = 4 + 4 + 4 + 4 + 7 * 8;  // bytes, with names of no letters
    std::vector<FrameTransform> transforms(reader.sequence(kSmallest));
    for (FrameTransform& t : transforms)
    {
        t.parent = readHeader(reader).frame;
        t.child = reader.text();
        t.translation = readVector(reader);
        const Vector3d axis = readVector(reader);
        t.rotation = {reader.number<double>(), axis.x(), axis.y(), axis.z()};
    }
    return transforms;
}

std::string readFrame(WireReader reader)
{
    return readHeader(reader).frame;
}
}  // namespace taut::bag
