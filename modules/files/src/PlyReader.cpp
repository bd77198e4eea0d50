#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>

#include "numbers.h"
#include "taut/files/PlyFile.h"

namespace taut
{
namespace
{
constexpr std::size_t kRowsAtOnce = 4096;
constexpr std::size_t kLongestHeaderLine = 4096;

/** The next line, without the carriage return that some programs write. */
bool readLine(std::istream& in, std::string& line)
{
    if (!std::getline(in, line)) return false;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return true;
}
}  // namespace

PlyReader::PlyReader(const std::string& path) : path_(path), in_(path, std::ios::binary)
{
    if (!in_) fail("cannot be opened");
    readHeader();
    if (!ascii_) checkLength();
}

void PlyReader::fail(const std::string& cause) const
{
    throw std::runtime_error("PLY file '" + path_ + "': " + cause);
}

void PlyReader::readHeader()
{
    if (!readLine(in_, line_) || line_ != "ply") fail("does not begin with 'ply'");
    bool in_vertices = false, vertices_seen = false, format_seen = false;
    for (;;)
    {
        if (!readLine(in_, line_)) fail("the header ends without 'end_header'");
        if (line_.size() > kLongestHeaderLine) fail("a line of the header is too long");
        std::istringstream words(line_);
        std::string keyword, name;
        words >> keyword >> name;
        if (keyword == "end_header") break;
        if (keyword == "format")
        {
            if (name != "ascii" && name != "binary_little_endian")
                fail("format '" + name + "' is not supported");
            ascii_ = name == "ascii";
            format_seen = true;
        }
        else if (keyword == "element")
        {
            if (!vertices_seen && name != "vertex")
                fail("element '" + name + "' before the vertices is not supported");
            in_vertices = !vertices_seen;
            more_elements_ = vertices_seen;
            if (in_vertices && !(words >> size_)) fail("bad number of vertices in '" + line_ + "'");
            vertices_seen = true;
        }
        else if (keyword == "property")
        {
            if (in_vertices) readProperty(line_);
        }
        else if (keyword != "comment" && keyword != "obj_info")
        {
            fail("unknown line in the header: '" + line_ + "'");
        }
    }
    if (!format_seen) fail("the header states no format");
    if (names_.empty()) fail("the header states no vertices");
}

void PlyReader::readProperty(const std::string& line)
{
    static const std::map<std::string, Type> types{
        {"char", Type::Int8},      {"int8", Type::Int8},       {"uchar", Type::UInt8},
        {"uint8", Type::UInt8},    {"short", Type::Int16},     {"int16", Type::Int16},
        {"ushort", Type::UInt16},  {"uint16", Type::UInt16},   {"int", Type::Int32},
        {"int32", Type::Int32},    {"uint", Type::UInt32},     {"uint32", Type::UInt32},
        {"float", Type::Float32},  {"float32", Type::Float32}, {"double", Type::Float64},
        {"float64", Type::Float64}};
    std::istringstream words(line);
    std::string keyword, type, name;
    words >> keyword >> type >> name;
    const auto it = types.find(type);
    if (it == types.end() || name.empty())
        fail("property of the vertices is not supported: '" + line + "'");
    names_.push_back(name);
    types_.push_back(it->second);
    row_bytes_ += sizeOf(it->second);
}

void PlyReader::checkLength()
{
    const auto header = static_cast<std::uintmax_t>(in_.tellg());
    const std::uintmax_t data = std::filesystem::file_size(path_) - header;
    if (size_ > data / row_bytes_)
        fail(
            "ends after " + std::to_string(data / row_bytes_) + " of " + std::to_string(size_) +
            " vertices");
    if (!more_elements_ && data > size_ * row_bytes_) failTooLong();
}

void PlyReader::failTooLong() const
{
    fail(
        "holds more data than the " + std::to_string(size_) +
        " vertices that the header states (was it closed after writing?)");
}

int PlyReader::column(const std::string& name) const
{
    const auto it = std::find(names_.begin(), names_.end(), name);
    return it == names_.end() ? -1 : static_cast<int>(it - names_.begin());
}

bool PlyReader::next(std::vector<double>& row)
{
    if (done_ == size_) return false;
    row.resize(names_.size());
    if (ascii_)
        nextAscii(row);
    else
        nextBinary(row);
    ++done_;
    return true;
}

void PlyReader::nextAscii(std::vector<double>& row)
{
    if (!readLine(in_, line_))
        fail("ends after " + std::to_string(done_) + " of " + std::to_string(size_) + " vertices");
    if (!parseRow(line_, row))
        fail("vertex " + std::to_string(done_) + " is not a row of numbers: '" + line_ + "'");
    if (done_ + 1 < size_ || more_elements_) return;
    while (readLine(in_, line_))
        if (line_.find_first_not_of(" \t") != std::string::npos) failTooLong();
}

void PlyReader::nextBinary(std::vector<double>& row)
{
    if (buffer_position_ == buffer_.size())
    {
        buffer_.resize(row_bytes_ * std::min(kRowsAtOnce, size_ - done_));
        buffer_position_ = 0;
        if (!in_.read(buffer_.data(), static_cast<std::streamsize>(buffer_.size())))
            fail("cannot be read at vertex " + std::to_string(done_));
    }
    for (std::size_t i = 0; i < row.size(); ++i)
    {
        row[i] = decode(types_[i], &buffer_[buffer_position_]);
        buffer_position_ += sizeOf(types_[i]);
    }
}

std::size_t PlyReader::sizeOf(Type type)
{
    switch (type)
    {
        case Type::Int8:
        case Type::UInt8:
            return 1;
        case Type::Int16:
        case Type::UInt16:
            return 2;
        case Type::Int32:
        case Type::UInt32:
        case Type::Float32:
            return 4;
        case Type::Float64:
            break;
    }
    return 8;
}

double PlyReader::decode(Type type, const char* bytes)
{
    switch (type)
    {
        case Type::Int8:
            return valueAt<std::int8_t>(bytes);
        case Type::UInt8:
            return valueAt<std::uint8_t>(bytes);
        case Type::Int16:
            return valueAt<std::int16_t>(bytes);
        case Type::UInt16:
            return valueAt<std::uint16_t>(bytes);
        case Type::Int32:
            return valueAt<std::int32_t>(bytes);
        case Type::UInt32:
            return valueAt<std::uint32_t>(bytes);
        case Type::Float32:
            return valueAt<float>(bytes);
        case Type::Float64:
            break;
    }
    return valueAt<double>(bytes);
}

std::vector<PlyPoint> readPlyPoints(const std::string& path)
{
    PlyReader reader(path);
    const auto required = [&](const char* name)
    {
        const int column = reader.column(name);
        if (column < 0)
            throw std::runtime_error("PLY file '" + path + "': no property '" + name + "'");
        return static_cast<std::size_t>(column);
    };
    const std::size_t x = required("x"), y = required("y"), z = required("z");
    const int intensity = reader.column("intensity");

    std::vector<PlyPoint> points;
    std::vector<double> row;
    while (reader.next(row))
    {
        PlyPoint point;
        point.position = Eigen::Vector3d(row[x], row[y], row[z]).cast<float>();
        if (intensity >= 0)
            point.intensity = static_cast<float>(row[static_cast<std::size_t>(intensity)]);
        points.push_back(point);
    }
    return points;
}
}  // namespace taut
