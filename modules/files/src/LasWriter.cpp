#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <utility>

#include "taut/files/LasFile.h"

namespace taut
{
namespace
{
constexpr std::size_t kHeaderBytes = 227, kRowBytes = 28;
constexpr std::size_t kMostHeld = 1 << 20;  // [bytes] of rows
constexpr std::size_t kMostPoints = std::numeric_limits<std::uint32_t>::max();
constexpr double kScale = 0.001;          // [m]
constexpr float kFarthest = 2'147'000.f;  // [m]: 32 bits of mm
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kUnixFrom = 946'684'800 * kSecond;  // 2000-01-01
constexpr std::int64_t kGpsEpoch = 315'964'800;            // 1980-01-06 [s since the UNIX epoch]
constexpr std::int64_t kAdjustment = 1'000'000'000;        // [s]
constexpr std::uint16_t kStandardGpsTime = 1;              // of the global encoding

/** Leap seconds since the GPS epoch, from these UNIX times [s] on: IERS Bulletin C. */
constexpr std::pair<std::int64_t, std::int64_t> kLeapSeconds[] = {
    {1'483'228'800, 18}, {1'435'708'800, 17}, {1'341'100'800, 16},
    {1'230'768'000, 15}, {1'136'073'600, 14}, {0, 13}};

/** Puts a number into a record, lowest byte first. */
template <class T>
void put(char* record, std::size_t at, T value)
{
    std::memcpy(record + at, &value, sizeof value);
}

template <class T>
T valueIn(const char* record, std::size_t at)
{
    T value;
    std::memcpy(&value, record + at, sizeof value);
    return value;
}
}  // namespace

LasPointWriter::LasPointWriter(std::string path)
    : path_(std::move(path)), out_(path_, std::ios::binary)
{
    if (!out_) fail();
    flush();
}

LasPointWriter::~LasPointWriter()
{
    try
    {
        close();
    }
    catch (const std::exception&)  // documented: call close() to see it
    {
    }
}

void LasPointWriter::fail()
{
    const std::string cause = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
    out_.close();
    std::error_code ignored;  // the header stands for no more than the last flush
    std::filesystem::resize_file(path_, kHeaderBytes + whole_ * kRowBytes, ignored);
    throw std::runtime_error("LAS file '" + path_ + "' cannot be written" + cause);
}

bool LasPointWriter::fits(const Eigen::Vector3f& position)
{
    return position.cwiseAbs().maxCoeff() <= kFarthest;
}

double LasPointWriter::timeOf(std::int64_t t) const
{
    std::int64_t seconds = t / kSecond;
    const auto rest = static_cast<double>(t % kSecond) * 1e-9;
    if (is_gps_time_)
    {
        const auto leap = std::find_if(
            std::begin(kLeapSeconds), std::end(kLeapSeconds) - 1,
            [&](const auto& since) { return seconds >= since.first; });
        seconds += leap->second - kGpsEpoch - kAdjustment;
    }
    return static_cast<double>(seconds) + rest;
}

bool LasPointWriter::append(const LasPoint& point)
{
    if (!point.position.allFinite() || !std::isfinite(point.intensity))
        throw std::runtime_error(
            "LAS file '" + path_ + "': point " + std::to_string(size_) + " is not finite");
    if (!fits(point.position.cast<float>()) || size_ == kMostPoints) return false;
    if (size_ == 0) is_gps_time_ = point.t >= kUnixFrom;
    std::array<char, kRowBytes> row{};
    for (std::size_t axis = 0; axis < 3; axis++)
        put(row.data(), 4 * axis,
            static_cast<std::int32_t>(std::llround(point.position[axis] / kScale)));
    const float stretched = std::min(std::max(point.intensity, 0.f), 255.f) * 257;
    put(row.data(), 12, static_cast<std::uint16_t>(std::lround(stretched)));
    put(row.data(), 14, std::uint8_t{0x09});  // the first return of one
    put(row.data(), 20, timeOf(point.t));
    appendRow(row.data());
    return true;
}

void LasPointWriter::appendRow(const char* row)
{
    if (!out_.is_open()) throw std::runtime_error("LAS file '" + path_ + "' is closed");
    for (std::size_t axis = 0; axis < 3; axis++)
    {
        const auto at = valueIn<std::int32_t>(row, 4 * axis);
        min_[axis] = size_ == 0 ? at : std::min(min_[axis], at);
        max_[axis] = size_ == 0 ? at : std::max(max_[axis], at);
    }
    rows_.append(row, kRowBytes);
    ++size_;
    if (rows_.size() >= kMostHeld) flush();
}

/* The public header block, 4.2 of the specification: what is not set here is zero. */
std::string LasPointWriter::header() const
{
    std::string bytes(kHeaderBytes, '\0');
    char* h = bytes.data();
    const auto count = static_cast<std::uint32_t>(size_);
    std::memcpy(h, "LASF", 4);
    put(h, 6, is_gps_time_ ? kStandardGpsTime : std::uint16_t{0});
    put(h, 24, std::uint8_t{1});  // version 1.2
    put(h, 25, std::uint8_t{2});
    std::memcpy(h + 26, "OTHER", 5);  // system: none of those that the specification names
    std::memcpy(h + 58, "taut", 4);
    put(h, 94, static_cast<std::uint16_t>(kHeaderBytes));
    put(h, 96, static_cast<std::uint32_t>(kHeaderBytes));  // where the points begin
    put(h, 104, std::uint8_t{1});                          // point format
    put(h, 105, static_cast<std::uint16_t>(kRowBytes));
    put(h, 107, count);
    put(h, 111, count);  // all are first returns
    for (std::size_t axis = 0; axis < 3; axis++)
    {
        put(h, 131 + 8 * axis, kScale);
        put(h, 179 + 16 * axis, max_[axis] * kScale);
        put(h, 187 + 16 * axis, min_[axis] * kScale);
    }
    return bytes;
}

void LasPointWriter::flush()
{
    errno = 0;
    out_.seekp(0, std::ios::end);
    out_ << rows_ << std::flush;  // before the header, which must not promise too much
    out_.seekp(0);
    out_ << header() << std::flush;
    if (!out_) fail();
    rows_.clear();
    whole_ = size_;
}

void LasPointWriter::close()
{
    if (!out_.is_open()) return;
    flush();
    out_.close();
}

void LasPointWriter::filter(const std::string& path, const std::function<bool(std::size_t)>& keep)
{
    std::ifstream in(path, std::ios::binary);
    std::array<char, kHeaderBytes> h{};
    if (!in.read(h.data(), h.size())) throw std::runtime_error("cannot read '" + path + "'");
    const std::string part = path + ".part";
    LasPointWriter stays(part);
    stays.is_gps_time_ = (valueIn<std::uint16_t>(h.data(), 6) & kStandardGpsTime) != 0;
    const std::size_t points = valueIn<std::uint32_t>(h.data(), 107);
    std::array<char, kRowBytes> row{};
    for (std::size_t i = 0; i < points; i++)
    {
        if (!in.read(row.data(), row.size()))
            throw std::runtime_error("cannot read '" + path + "'");
        if (keep(i)) stays.appendRow(row.data());
    }
    stays.close();
    std::filesystem::rename(part, path);
}
}  // namespace taut
