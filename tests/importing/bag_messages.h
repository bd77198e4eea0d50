#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Imu.h"
#include "taut/core/Scan.h"

/** \file bag_messages.h
 * ROS messages as bytes, for both wires. */
namespace taut::test
{
using Blob = std::vector<std::uint8_t>;

enum class TestWire
{
    Ros1,
    Cdr,
    CdrBigEndian
};

template <class T>
void append(Blob& blob, T value, bool big_endian = false)
{
    std::uint8_t raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big_endian) std::reverse(raw, raw + sizeof(T));
    blob.insert(blob.end(), raw, raw + sizeof(T));
}

/** Writes what a message is made of. */
class WireWriter
{
 public:
    explicit WireWriter(TestWire wire) : wire_(wire) {}

    template <class T>
    void number(T value)
    {
        if (wire_ != TestWire::Ros1)
            while (body_.size() % sizeof(T) != 0) body_.push_back(0);
        append(body_, value, wire_ == TestWire::CdrBigEndian);
    }
    void text(const std::string& text)
    {
        const bool zero = wire_ != TestWire::Ros1;
        number(static_cast<std::uint32_t>(text.size() + (zero ? 1 : 0)));
        body_.insert(body_.end(), text.begin(), text.end());
        if (zero) body_.push_back(0);
    }
    void bytes(const Blob& blob)
    {
        number(static_cast<std::uint32_t>(blob.size()));
        body_.insert(body_.end(), blob.begin(), blob.end());
    }
    void header(Time stamp, const std::string& frame = "os_lidar")
    {
        if (wire_ == TestWire::Ros1) number(std::uint32_t{7});  // seq
        number(static_cast<std::uint32_t>(stamp / 1'000'000'000));
        number(static_cast<std::uint32_t>(stamp % 1'000'000'000));
        text(frame);
    }
    Blob message() const
    {
        Blob all;
        if (wire_ == TestWire::Cdr) all = {0, 1, 0, 0};
        if (wire_ == TestWire::CdrBigEndian) all = {0, 0, 0, 0};
        all.insert(all.end(), body_.begin(), body_.end());
        return all;
    }

 private:
    TestWire wire_;
    Blob body_;
};

inline Blob imuMessage(
    const ImuSample& sample, TestWire wire, const std::string& frame = "os_lidar")
{
    WireWriter out(wire);
    out.header(sample.t, frame);
    for (int i = 0; i < 4 + 9; i++) out.number(0.25 * i);
    for (int i = 0; i < 3; i++) out.number(sample.gyro[i]);
    for (int i = 0; i < 9; i++) out.number(-0.5);
    for (int i = 0; i < 3; i++) out.number(sample.accel[i]);
    for (int i = 0; i < 9; i++) out.number(-0.25);
    return out.message();
}

/** One transform of a tf2_msgs/TFMessage. */
struct TestTransform
{
    std::string parent, child;
    Vector3d translation = Vector3d::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

inline TestTransform transformOf(
    const std::string& parent, const std::string& child, const Pose& T_parent_child)
{
    return {parent, child, T_parent_child.p, Eigen::Quaterniond(T_parent_child.R)};
}

inline Blob transformsMessage(const std::vector<TestTransform>& transforms, TestWire wire)
{
    WireWriter out(wire);
    out.number(static_cast<std::uint32_t>(transforms.size()));
    for (const TestTransform& t : transforms)
    {
        out.header(1'700'000'000'000'000'000, t.parent);
        out.text(t.child);
        for (int i = 0; i < 3; i++) out.number(t.translation[i]);
        for (const double value : {t.rotation.x(), t.rotation.y(), t.rotation.z(), t.rotation.w()})
            out.number(value);
    }
    return out.message();
}

/** How a driver writes its clouds. */
struct CloudStyle
{
    std::string time_name = "t", time_type = "uint32";
    double time_unit = 1;      //!< [ns]
    bool absolute = false;     //!< times since 1970, else since the stamp
    Duration clock_shift = 0;  //!< of the absolute times against the stamps [ns]
    double stamp_at = 0;       //!< place of the stamp in the sweep: 0 its start, 1 its end
    bool big_endian_data = false;
    std::string intensity_name = "intensity", ring_name = "ring", ring_type = "uint16";
    int rows = 1;                    //!< of the cloud, each padded by some bytes
    bool with_holes = false;         //!< a NaN, and a point at the origin, after every tenth point
    std::string frame = "os_lidar";  //!< frame_id
    bool stamped = true;             //!< else the stamp is zero
    double intensity_scale = 1;      //!< to what is written
    std::vector<std::string> more_fields;  //!< float32, all zero
    /** What the time of the i-th point becomes, if it is there. */
    std::function<double(std::size_t i, double time)> spoil;
};

inline std::uint8_t datatypeOf(const std::string& type)
{
    const std::vector<std::string> types{"",      "int8",   "uint8",   "int16",  "uint16",
                                         "int32", "uint32", "float32", "float64"};
    const auto it = std::find(types.begin(), types.end(), type);
    return static_cast<std::uint8_t>(it - types.begin());
}

/** Appends a value as the type says. */
inline void appendAs(Blob& blob, const std::string& type, double value, bool big_endian)
{
    if (type == "uint8") append(blob, static_cast<std::uint8_t>(value), big_endian);
    if (type == "uint16") append(blob, static_cast<std::uint16_t>(value), big_endian);
    if (type == "uint32") append(blob, static_cast<std::uint32_t>(value), big_endian);
    if (type == "float32") append(blob, static_cast<float>(value), big_endian);
    if (type == "float64") append(blob, value, big_endian);
}

/** Writes a sweep the way a driver does. */
class CloudWriter
{
 public:
    CloudWriter(const Scan& scan, const CloudStyle& style, TestWire wire)
        : style_(style), stamp_(stampOf(scan, style)), wire_(wire)
    {
        for (const LidarPoint& point : scan.points)
        {
            add(point, scan.timeOf(point));
            if (!style.with_holes || ++since_hole_ < 10) continue;
            since_hole_ = 0;
            LidarPoint hole = point;
            hole.position.setZero();
            add(hole, scan.timeOf(point));
            hole.position.setConstant(std::numeric_limits<float>::quiet_NaN());
            add(hole, scan.timeOf(point));
        }
    }

    static Time stampOf(const Scan& scan, const CloudStyle& style)
    {
        return scan.stamp +
               std::llround(style.stamp_at * static_cast<double>(scan.end - scan.stamp));
    }

    Blob message() const
    {
        const auto width = static_cast<std::uint32_t>(points_.size()) / style_.rows;
        WireWriter out(wire_);
        out.header(style_.stamped ? stamp_ : 0, style_.frame);
        out.number(static_cast<std::uint32_t>(style_.rows));
        out.number(width);
        out.number(static_cast<std::uint32_t>(fields_.size()));
        for (const auto& [name, type, offset] : fields_)
        {
            out.text(name);
            out.number(offset);
            out.number(datatypeOf(type));
            out.number(std::uint32_t{1});
        }
        const auto step = static_cast<std::uint32_t>(points_.front().size());
        const std::uint32_t padding = style_.rows > 1 ? 5 : 0;
        out.number(static_cast<std::uint8_t>(style_.big_endian_data));
        out.number(step);
        out.number(width * step + padding);
        Blob data;
        for (std::size_t i = 0; i < points_.size(); i++)
        {
            data.insert(data.end(), points_[i].begin(), points_[i].end());
            if ((i + 1) % width == 0) data.insert(data.end(), padding, 0xEE);
        }
        out.bytes(data);
        out.number(std::uint8_t{1});  // is_dense
        return out.message();
    }

 private:
    struct Field
    {
        std::string name, type;
        std::uint32_t offset;
    };

    void value(Blob& point, const std::string& name, const std::string& type, double value)
    {
        if (name.empty()) return;
        if (points_.empty())
            fields_.push_back({name, type, static_cast<std::uint32_t>(point.size())});
        appendAs(point, type, value, style_.big_endian_data);
    }

    void add(const LidarPoint& from, Time t)
    {
        Blob point;
        value(point, "x", "float32", double{from.position.x()});
        value(point, "y", "float32", double{from.position.y()});
        value(point, "z", "float32", double{from.position.z()});
        append(point, std::uint32_t{0xDEADBEEF});  // padding, as PCL has it
        value(
            point, style_.intensity_name, "float32",
            style_.intensity_scale * double{from.intensity});
        value(point, style_.ring_name, style_.ring_type, from.ring);
        const Time since = style_.absolute ? t + style_.clock_shift : t - stamp_;
        double time = style_.time_unit == 1e9
                          ? static_cast<double>(since / 1'000'000'000) +
                                1e-9 * static_cast<double>(since % 1'000'000'000)
                          : static_cast<double>(since) / style_.time_unit;
        if (style_.spoil) time = style_.spoil(points_.size(), time);
        value(point, style_.time_name, style_.time_type, time);
        for (const std::string& name : style_.more_fields) value(point, name, "float32", 0);
        points_.push_back(std::move(point));
    }

    CloudStyle style_;
    Time stamp_;
    TestWire wire_;
    int since_hole_ = 0;
    std::vector<Field> fields_;
    std::vector<Blob> points_;
};

/** A sweep as a Livox CustomMsg. */
inline Blob livoxMessage(
    const Scan& scan, TestWire wire, Duration clock_shift = 0, int lidar_id = 3)
{
    WireWriter out(wire);
    out.header(scan.stamp);
    out.number(static_cast<std::uint64_t>(scan.stamp + clock_shift));
    out.number(static_cast<std::uint32_t>(scan.points.size()));
    for (const int i : {lidar_id, 0, 0, 0}) out.number(static_cast<std::uint8_t>(i));
    out.number(static_cast<std::uint32_t>(scan.points.size()));
    for (const LidarPoint& point : scan.points)
    {
        out.number(static_cast<std::uint32_t>(point.offset));
        for (int i = 0; i < 3; i++) out.number(point.position[i]);
        out.number(static_cast<std::uint8_t>(point.intensity));
        out.number(std::uint8_t{0x10});  // tag
        out.number(static_cast<std::uint8_t>(point.ring));
    }
    return out.message();
}
}  // namespace taut::test
