#include <cmath>
#include <stdexcept>

#include "taut/files/PlyFile.h"

namespace taut
{
namespace
{
/** The header has the same length for every number of points, so that close() can write it again.
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
    out_ << header(0);
    checkStream();
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

void PlyPointWriter::checkStream()
{
    if (!out_) throw std::runtime_error("PLY file '" + path_ + "' cannot be written");
}

void PlyPointWriter::append(const PlyPoint& point)
{
    if (!out_.is_open()) throw std::runtime_error("PLY file '" + path_ + "' is closed");
    if (!point.position.allFinite() || !std::isfinite(point.intensity))
        throw std::runtime_error(
            "PLY file '" + path_ + "': point " + std::to_string(size_) + " is not finite");
    const float row[] = {
        point.position.x(), point.position.y(), point.position.z(), point.intensity};
    out_.write(reinterpret_cast<const char*>(row), sizeof(row));
    checkStream();
    ++size_;
}

void PlyPointWriter::close()
{
    if (!out_.is_open()) return;
    out_.seekp(0);
    out_ << header(size_);
    out_.flush();
    checkStream();
    out_.close();
    checkStream();
}
}  // namespace taut
