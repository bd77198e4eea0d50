#include "RawSweep.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "../TimeField.h"

namespace taut::bag
{
namespace
{
constexpr std::uint64_t kLargestTime = 4'000'000'000'000'000'000;  // ns, the year 2096

enum Datatype : std::uint8_t
{
    kInt8 = 1,
    kUint8,
    kInt16,
    kUint16,
    kInt32,
    kUint32,
    kFloat32,
    kFloat64
};
constexpr std::uint32_t kBytes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
constexpr const char* kNames[] = {"",      "int8",   "uint8",   "int16",  "uint16",
                                  "int32", "uint32", "float32", "float64"};

/** A field of a cloud, ready to be read. */
class Column
{
 public:
    Column(const PointField& field, const PointCloud2& cloud)
        : field_(field), big_endian_(cloud.big_endian)
    {
        if (field.datatype < kInt8 || field.datatype > kFloat64)
            throw std::runtime_error("the field '" + field.name + "' has no known type");
        if (field.offset > cloud.point_step ||
            kBytes[field.datatype] > cloud.point_step - field.offset)
            throw std::runtime_error("the field '" + field.name + "' is not within a point");
    }

    double read(const std::uint8_t* point) const
    {
        const std::uint8_t* at = point + field_.offset;
        switch (field_.datatype)
        {
            case kInt8:
                return ByteReader::numberAt<std::int8_t>(at, false);
            case kUint8:
                return *at;
            case kInt16:
                return ByteReader::numberAt<std::int16_t>(at, big_endian_);
            case kUint16:
                return ByteReader::numberAt<std::uint16_t>(at, big_endian_);
            case kInt32:
                return ByteReader::numberAt<std::int32_t>(at, big_endian_);
            case kUint32:
                return ByteReader::numberAt<std::uint32_t>(at, big_endian_);
            case kFloat32:
                return double{ByteReader::numberAt<float>(at, big_endian_)};
            default:
                return ByteReader::numberAt<double>(at, big_endian_);
        }
    }

    std::string describe() const { return field_.name + " (" + kNames[field_.datatype] + ")"; }

    bool isFloat32() const { return field_.datatype == kFloat32; }

    /** As the name says; else integers have ns, floats s; a float64 has s (Hesai, RoboSense) or ns
     * (Livox). */
    double nominalTimeUnit() const
    {
        if (const double unit = unitOfName(field_.name); unit > 0) return unit;
        return field_.datatype == kFloat64 ? 0 : field_.datatype == kFloat32 ? 1e9 : 1;
    }

 private:
    PointField field_;
    bool big_endian_;
};

std::optional<Column> find(const PointCloud2& cloud, std::initializer_list<const char*> names)
{
    for (const char* name : names)
        for (const auto& field : cloud.fields)
            if (field.name == name) return Column(field, cloud);
    return {};
}

std::optional<Column> findTime(const PointCloud2& cloud, const std::string& asked)
{
    std::vector<std::string> names;
    for (const auto& field : cloud.fields) names.push_back(field.name);
    int found = -1;
    try
    {
        found = timeFieldOf(names, asked);
    }
    catch (const std::runtime_error& e)
    {
        throw FieldError(e.what());
    }
    if (found < 0) return {};
    return Column(cloud.fields[static_cast<std::size_t>(found)], cloud);
}

struct Columns
{
    Columns(const PointCloud2& cloud, const std::string& time_field)
        : x(find(cloud, {"x"})),
          y(find(cloud, {"y"})),
          z(find(cloud, {"z"})),
          intensity(find(cloud, {"intensity", "reflectivity", "i"})),
          ring(find(cloud, {"ring", "line", "channel", "laser_id"})),
          time(findTime(cloud, time_field))
    {
        if (!x || !y || !z) throw std::runtime_error("it has no fields x, y and z");
    }
    std::optional<Column> x, y, z, intensity, ring, time;
};

/** Row and point steps that stay within the data. */
void checkLayout(const PointCloud2& cloud)
{
    if (cloud.width == 0 || cloud.height == 0) return;
    const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
    if (cloud.point_step == 0 || (cloud.height > 1 && cloud.row_step < row) ||
        cloud.data.size < row ||
        (cloud.height > 1 && (cloud.data.size - row) / cloud.row_step < cloud.height - 1))
        throw std::runtime_error(
            "it has " + std::to_string(cloud.data.size) + " bytes, too few for " +
            std::to_string(cloud.height) + " rows of " + std::to_string(cloud.width) +
            " points of " + std::to_string(cloud.point_step) + " bytes");
}

/** Takes the point if it is one. */
void add(RawSweep& sweep, const LidarPoint& point, std::optional<double> time)
{
    if (point.position.isZero(0) || !point.position.allFinite()) return;  // no return
    if (time && !std::isfinite(*time))
    {
        sweep.bad_times++;
        return;
    }
    sweep.points.push_back(point);
    if (time) sweep.times.push_back(*time);
    if (point.ring > 0) sweep.rings = std::max(sweep.rings, point.ring + 1);
}

/** 0 for what cannot be the number of a ring. */
std::uint16_t ringOf(double value)
{
    return value > 0 && value < 65536 ? static_cast<std::uint16_t>(value) : 0;
}

}  // namespace

RawSweep toRawSweep(const PointCloud2& cloud, const std::string& time_field)
{
    const Columns columns(cloud, time_field);
    checkLayout(cloud);
    RawSweep sweep;
    sweep.header = cloud.stamp;
    sweep.sensor = cloud.frame;
    if (columns.time)
    {
        sweep.time_field = columns.time->describe();
        sweep.nominal_unit = columns.time->nominalTimeUnit();
        sweep.single_precision = columns.time->isFloat32();
    }
    if (cloud.width == 0) return sweep;  // whatever number of rows it claims
    for (std::uint32_t row = 0; row < cloud.height; row++)
        for (std::uint32_t column = 0; column < cloud.width; column++)
        {
            const std::uint8_t* at = cloud.data.data + std::size_t{row} * cloud.row_step +
                                     std::size_t{column} * cloud.point_step;
            LidarPoint point;
            point.position =
                Eigen::Vector3d(columns.x->read(at), columns.y->read(at), columns.z->read(at))
                    .cast<float>();
            const double intensity = columns.intensity ? columns.intensity->read(at) : 0;
            if (std::isfinite(intensity)) point.intensity = static_cast<float>(intensity);
            if (columns.ring) point.ring = ringOf(columns.ring->read(at));
            add(sweep, point, columns.time ? std::optional(columns.time->read(at)) : std::nullopt);
        }
    return sweep;
}

RawSweep toRawSweep(const Livox& livox)
{
    if (livox.timebase > kLargestTime) throw std::runtime_error("its timebase is not a time");
    RawSweep sweep;
    sweep.header = livox.stamp;
    sweep.sensor = std::to_string(livox.lidar_id);
    sweep.base = static_cast<Time>(livox.timebase);
    sweep.time_field = "offset_time (uint32)";
    for (const LivoxPoint& from : livox.points)
    {
        LidarPoint point;
        point.position = {from.x, from.y, from.z};
        point.intensity = from.reflectivity;
        point.ring = from.line;
        add(sweep, point, static_cast<double>(from.offset_time));
    }
    return sweep;
}
}  // namespace taut::bag
