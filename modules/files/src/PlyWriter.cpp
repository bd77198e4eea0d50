#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "taut/files/PlyFile.h"

namespace taut
{
namespace
{
constexpr std::size_t kRowBytes = 16;
constexpr std::size_t kMostHeld = 1 << 20;  // [bytes] of rows

/** The header has the same length for every number of points, so that flush() can write it again.
 */
std::string header(std::size_t points)
{
    constexpr std::size_t kDigits = 20;
    const std::string count = std::to_string(points);
    return "ply\nformat binary_little_endian 1.0\ncomment " +
           std::string(kDigits - count.size(), '-') + "\nelement vertex " + count +
           "\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\n"
           "end_header\n";
}
}  // namespace

PlyPointWriter::PlyPointWriter(std::string path)
    : path_(std::move(path)), out_(path_, std::ios::binary)
{
    if (!out_) fail();
    flush();
}

PlyPointWriter::~PlyPointWriter()
{
    try
    {
        close();
    }
    catch (const std::exception&)  // documented: call close() to see it
    {
    }
}

void PlyPointWriter::fail()
{
    const std::string cause = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
    out_.close();
    std::error_code ignored;  // the header stands for no more than the last flush
    std::filesystem::resize_file(path_, header(0).size() + whole_ * kRowBytes, ignored);
    throw std::runtime_error("PLY file '" + path_ + "' cannot be written" + cause);
}

void PlyPointWriter::append(const PlyPoint& point)
{
    if (!out_.is_open()) throw std::runtime_error("PLY file '" + path_ + "' is closed");
    if (!point.position.allFinite() || !std::isfinite(point.intensity))
        throw std::runtime_error(
            "PLY file '" + path_ + "': point " + std::to_string(size_) + " is not finite");
    const float row[] = {
        point.position.x(), point.position.y(), point.position.z(), point.intensity};
    static_assert(sizeof(row) == kRowBytes);
    rows_.append(reinterpret_cast<const char*>(row), kRowBytes);
    ++size_;
    if (rows_.size() >= kMostHeld) flush();
}

void PlyPointWriter::flush()
{
    errno = 0;
    out_.seekp(0, std::ios::end);
    out_ << rows_ << std::flush;  // before the header, which must not promise too much
    out_.seekp(0);
    out_ << header(size_) << std::flush;
    if (!out_) fail();
    rows_.clear();
    whole_ = size_;
}

void PlyPointWriter::close()
{
    if (!out_.is_open()) return;
    flush();
    out_.close();
}
}  // namespace taut
