#include "ObjectCopy.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace taut
{
namespace
{
constexpr std::uint64_t kMostBytes = 160u << 20;  // of an object
constexpr std::uint64_t kMostPoints = 1u << 22;   // of a scan: eight times what sensors give
constexpr std::uint64_t kMostLasers = 1u << 16;   // their numbers have 16 bits
constexpr std::uint64_t kMostImuValues = 1u << 8;
constexpr std::uint64_t kLongestString = 1u << 16;
constexpr std::size_t kPiece = 1u << 20;
constexpr std::size_t kPacket = 1206, kPointsOfPacket = 384, kLaserCorrection = 9 * 8;
constexpr int kImuValues = 31;  // of version 4, which does not write their number

[[noreturn]] void throwVersion(const std::string& name, int version)
{
    throw std::runtime_error(
        "version " + std::to_string(version) + " of the class '" + name + "' is not known");
}

void checkSize(std::uint64_t claimed, std::uint64_t most)
{
    if (claimed > most)
        throw std::runtime_error(
            "an object claims " + std::to_string(claimed) + " elements where " +
            std::to_string(most) + " are the most that make sense");
}
}  // namespace

bool ObjectCopy::knows(const std::string& short_name)
{
    return short_name == "CObservationIMU" || short_name == "CObservationVelodyneScan" ||
           short_name == "CObservationRotatingScan";
}

ObjectCopy::ObjectCopy(GzInput& input, const ObjectHeader& header) : input_(input)
{
    take(header.bytes);
    const std::string name = header.shortName();
    if (name == "CObservationIMU")
        imu(header.version);
    else if (name == "CObservationVelodyneScan")
        velodyne(header.version);
    else if (name == "CObservationRotatingScan")
        rotating(header.version);
    else
        throw std::logic_error("not a class that can be copied");
    end();
}

/* Piece by piece, so that a size that is not true costs no more than the rest of the file. */
const std::uint8_t* ObjectCopy::take(std::uint64_t count)
{
    const std::size_t at = bytes_.size();
    checkSize(at + count, kMostBytes);
    for (std::uint64_t left = count; left > 0;)
    {
        const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(left, kPiece));
        const std::size_t old = bytes_.size();
        bytes_.resize(old + piece);
        input_.read(bytes_.data() + old, piece);
        left -= piece;
    }
    return bytes_.data() + at;
}

template <class T>
T ObjectCopy::number()
{
    T value;
    std::memcpy(&value, take(sizeof value), sizeof value);
    return value;
}

/* A vector: its size, then its values. */
std::uint64_t ObjectCopy::values(std::size_t bytes_each, std::uint64_t most)
{
    const std::uint64_t n = number<std::uint32_t>();
    checkSize(n, most);
    take(n * bytes_each);
    return n;
}

/* MRPT copies their bytes into `bool`, for which others than 0 and 1 are undefined. */
void ObjectCopy::flags(std::size_t count)
{
    take(count);
    for (auto at = bytes_.end() - static_cast<std::ptrdiff_t>(count); at != bytes_.end(); ++at)
        *at = *at != 0;
}

void ObjectCopy::string()
{
    values(1, kLongestString);
}

void ObjectCopy::end()
{
    if (number<std::uint8_t>() != kObjectEnd)
        throw std::runtime_error("the end mark of an object is missing");
}

/* An object within the object. */
void ObjectCopy::pose()
{
    const auto next = input_.peek(kLongestHeader);
    const auto header = parseObjectHeader(next.data, next.size);
    if (!header || header->shortName() != "CPose3D")
        throw std::runtime_error("there is no pose where one must be");
    take(header->bytes);
    if (header->version != 2 && header->version != 3) throwVersion(header->name, header->version);
    take(header->version == 2 ? 7 * 8 : 12 * 8);
    end();
}

void ObjectCopy::imu(int version)
{
    if (version > 4) throwVersion("CObservationIMU", version);
    pose();
    if (version == 4)
    {
        flags(kImuValues);         // which are there
        take(8 + kImuValues * 8);  // the stamp, the values
    }
    else
    {
        values(1, kMostImuValues);
        take(8);
        values(version == 0 ? 4 : 8, kMostImuValues);
    }
    string();
}

void ObjectCopy::velodyne(int version)
{
    if (version > 2) throwVersion("CObservationVelodyneScan", version);
    take(8);
    string();
    take(2 * 8);
    pose();
    values(kPacket, kMostPoints / kPointsOfPacket);
    values(kLaserCorrection, kMostLasers);
    for (int i = 0; i < 3; i++) values(4, kMostPoints);  // x, y, z
    values(1, kMostPoints);                              // intensity
    if (version >= 1) flags(1);
    if (version < 2) return;
    string();  // the types, in words
    string();
    values(8, kMostPoints);  // times
    values(4, kMostPoints);  // azimuths
    values(2, kMostPoints);  // lasers
    string();
    string();
    const auto lasers = number<std::uint32_t>();
    checkSize(lasers, kMostLasers);
    for (std::uint32_t i = 0; i < lasers; i++) values(8, kMostPoints);
}

void ObjectCopy::rotating(int version)
{
    if (version > 0) throwVersion("CObservationRotatingScan", version);
    take(8);
    string();
    take(2 * 2 + 4 * 8);  // rows, columns; resolution, azimuths, duration
    string();
    take(2 * 8);
    pose();
    take(8);
    flags(1);
    const std::uint64_t pixels = image(2);
    image(1);
    const auto layers = number<std::uint16_t>();
    if (layers > 0 && pixels == 0) throw std::runtime_error("a range image has layers but no size");
    for (int i = 0; i < layers; i++)
    {
        string();
        take(pixels * 2);
    }
}

/* Columns, rows and pixels; returns the number of pixels. */
std::uint64_t ObjectCopy::image(std::size_t bytes_each)
{
    const std::uint64_t columns = number<std::uint16_t>(), rows = number<std::uint16_t>();
    checkSize(columns * rows, kMostPoints);
    take(columns * rows * bytes_each);
    return columns * rows;
}
}  // namespace taut
