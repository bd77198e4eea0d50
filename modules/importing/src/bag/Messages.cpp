#include "Messages.h"

namespace taut::bag
{
namespace
{
/** std_msgs/Header; the frame's name is not needed: extrinsics come from the rig. */
Time readHeader(WireReader& reader)
{
    if (reader.wire() == Wire::Ros1) reader.number<std::uint32_t>();  // seq
    // Unsigned in ROS 1, signed in ROS 2: the same until 2038.
    const Time seconds = reader.wire() == Wire::Ros1 ? Time{reader.number<std::uint32_t>()}
                                                     : Time{reader.number<std::int32_t>()};
    const Time nanoseconds = reader.number<std::uint32_t>();
    if (nanoseconds >= 1'000'000'000) throw std::runtime_error("its stamp is not a time");
    reader.text();
    return seconds * 1'000'000'000 + nanoseconds;
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

PointCloud2 readPointCloud2(WireReader reader)
{
    PointCloud2 cloud;
    cloud.stamp = readHeader(reader);
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
    sweep.stamp = readHeader(reader);
    sweep.timebase = reader.number<std::uint64_t>();
    reader.number<std::uint32_t>();                             // point_num: the sequence knows
    for (int i = 0; i < 4; i++) reader.number<std::uint8_t>();  // lidar_id, rsvd[3]
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

ImuSample readImu(WireReader reader)
{
    ImuSample sample;
    sample.t = readHeader(reader);
    skipNumbers(reader, 4 + 9);  // orientation and its covariance
    sample.gyro = readVector(reader);
    skipNumbers(reader, 9);
    sample.accel = readVector(reader);
    return sample;
}
}  // namespace taut::bag
