#include "taut/submaps/SubmapFile.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace taut
{
namespace
{
constexpr char kMagic[] = "TAUTSUB2";
constexpr std::size_t kMagicSize = sizeof(kMagic) - 1;
constexpr std::size_t kHeaderSize = kMagicSize + 8;
constexpr std::uint32_t kLargest = 1u << 30;  // [bytes] of a submap; no real one is so large

class Encoder
{
 public:
    std::string bytes;

    template <class T>
    void number(const T& value)
    {
        static_assert(std::is_arithmetic_v<T>);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
    }
    template <class Derived>
    void matrix(const Eigen::MatrixBase<Derived>& m)
    {
        for (Eigen::Index c = 0; c < m.cols(); c++)
            for (Eigen::Index r = 0; r < m.rows(); r++) number(m(r, c));
    }
    void size(std::size_t n) { number(static_cast<std::uint32_t>(n)); }
    void pose(const Pose& T)
    {
        matrix(T.R);
        matrix(T.p);
    }
};

class Decoder
{
 public:
    explicit Decoder(const std::string& bytes) : bytes_(bytes) {}

    template <class T>
    void number(T& value)
    {
        if (bytes_.size() - at_ < sizeof(T)) throw std::runtime_error("it ends early");
        std::memcpy(&value, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
    }
    template <class Derived>
    void matrix(Eigen::MatrixBase<Derived>& m)
    {
        for (Eigen::Index c = 0; c < m.cols(); c++)
            for (Eigen::Index r = 0; r < m.rows(); r++) number(m(r, c));
    }
    /** Of elements that take at least so many bytes each. */
    std::size_t size(std::size_t bytes_each)
    {
        std::uint32_t n = 0;
        number(n);
        if (n > (bytes_.size() - at_) / bytes_each) throw std::runtime_error("it ends early");
        return n;
    }
    void pose(Pose& T)
    {
        matrix(T.R);
        matrix(T.p);
    }
    void expectEnd() const
    {
        if (at_ != bytes_.size()) throw std::runtime_error("there is more in it than there should");
    }

 private:
    const std::string& bytes_;
    std::size_t at_ = 0;
};

std::string encode(const Submap& s)
{
    Encoder out;
    out.number(s.id);
    out.pose(s.T_world_submap);
    out.matrix(s.up_submap);
    out.matrix(s.up_covariance);
    out.number(s.path_begin);
    out.number(s.path_end);
    out.number(s.reach);
    out.number(static_cast<std::uint8_t>(s.doubtful));
    out.size(s.scans.size());
    for (const SubmapScan& scan : s.scans)
    {
        out.number(scan.t);
        out.pose(scan.T_submap_imu);
        out.matrix(scan.covariance);
    }
    out.size(s.points.size());
    for (const SubmapPoint& p : s.points)
    {
        out.matrix(p.position);
        out.number(p.scan);
    }
    out.size(s.key_scans.size());
    for (const KeyScan& key : s.key_scans)
    {
        out.number(key.scan);
        out.pose(key.T_submap_sensor);
        out.number(key.blur);
        for (const std::uint16_t cell : key.image.cells()) out.number(cell);
    }
    return std::move(out.bytes);
}

Submap decode(const std::string& bytes)
{
    Decoder in(bytes);
    Submap s;
    std::uint8_t doubtful = 0;
    in.number(s.id);
    in.pose(s.T_world_submap);
    in.matrix(s.up_submap);
    in.matrix(s.up_covariance);
    in.number(s.path_begin);
    in.number(s.path_end);
    in.number(s.reach);
    in.number(doubtful);
    s.doubtful = doubtful != 0;
    s.scans.resize(in.size(8 + 12 * 8 + 36 * 8));
    for (SubmapScan& scan : s.scans)
    {
        in.number(scan.t);
        in.pose(scan.T_submap_imu);
        in.matrix(scan.covariance);
    }
    if (s.scans.empty()) throw std::runtime_error("it has no scans");
    s.points.resize(in.size(14));
    for (SubmapPoint& p : s.points)
    {
        in.matrix(p.position);
        in.number(p.scan);
        if (p.scan >= s.scans.size()) throw std::runtime_error("a point names a scan that is none");
    }
    s.key_scans.resize(in.size(2 + 13 * 8 + 2 * RangeImage::kColumns * RangeImage::kRows));
    for (KeyScan& key : s.key_scans)
    {
        in.number(key.scan);
        in.pose(key.T_submap_sensor);
        in.number(key.blur);
        for (std::uint16_t& cell : key.image.cells()) in.number(cell);
    }
    in.expectEnd();
    return s;
}

std::string compressed(const std::string& data)
{
    uLongf size = compressBound(data.size());
    std::string out(size, '\0');
    if (compress2(
            reinterpret_cast<Bytef*>(out.data()), &size,
            reinterpret_cast<const Bytef*>(data.data()), data.size(), Z_BEST_SPEED) != Z_OK)
        throw std::runtime_error("zlib cannot compress");
    out.resize(size);
    return out;
}

/** Memory follows what comes out: the size in the header may be damaged too. */
std::string uncompressed(const std::string& data, std::size_t size)
{
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) throw std::runtime_error("zlib cannot decompress");
    const std::unique_ptr<z_stream, int (*)(z_stream*)> closer(&stream, inflateEnd);
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(data.data()));
    stream.avail_in = static_cast<uInt>(data.size());
    std::string out;
    std::vector<char> buffer(1 << 18);
    int result = Z_OK;
    while (result == Z_OK && out.size() <= size)
    {
        stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
        stream.avail_out = static_cast<uInt>(buffer.size());
        result = inflate(&stream, Z_NO_FLUSH);
        out.append(buffer.data(), buffer.size() - stream.avail_out);
    }
    if (result != Z_STREAM_END || out.size() != size) throw std::runtime_error("it is damaged");
    return out;
}

std::uint32_t checksum(const std::string& data)
{
    return static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size())));
}

/** Closes a descriptor on every way out. */
struct Descriptor
{
    int fd;
    ~Descriptor()
    {
        if (fd >= 0) ::close(fd);
    }
};

void writeWhole(const std::string& path, const std::string& bytes)
{
    const auto fail = [&]
    { throw std::runtime_error("cannot write '" + path + "': " + std::strerror(errno)); };
    const std::string part = path + ".part";
    {
        const Descriptor file{::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)};
        if (file.fd < 0) fail();
        std::size_t done = 0;
        while (done < bytes.size())
        {
            const ssize_t n = ::write(file.fd, bytes.data() + done, bytes.size() - done);
            if (n < 0 && errno != EINTR) fail();
            if (n > 0) done += static_cast<std::size_t>(n);
        }
        if (::fsync(file.fd) != 0) fail();
    }
    if (std::rename(part.c_str(), path.c_str()) != 0) fail();
}

std::string readWhole(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(std::strerror(errno));
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    if (file.bad()) throw std::runtime_error("it cannot be read");
    return bytes;
}

Submap fromFile(const std::string& bytes)
{
    if (bytes.size() < kHeaderSize || bytes.compare(0, kMagicSize - 1, kMagic, kMagicSize - 1) != 0)
        throw std::runtime_error("it is no submap");
    if (bytes[kMagicSize - 1] != kMagic[kMagicSize - 1])
        throw std::runtime_error("it is of another version of taut");
    std::uint32_t size = 0, sum = 0;
    std::memcpy(&size, bytes.data() + kMagicSize, 4);
    std::memcpy(&sum, bytes.data() + kMagicSize + 4, 4);
    if (size > kLargest) throw std::runtime_error("it is damaged");
    const std::string stored = bytes.substr(kHeaderSize);
    if (checksum(stored) != sum) throw std::runtime_error("it is damaged");
    return decode(uncompressed(stored, size));
}
}  // namespace

void writeSubmap(const std::string& path, const Submap& submap)
{
    const std::string data = encode(submap);
    const auto size = static_cast<std::uint32_t>(data.size());
    const std::string stored = compressed(data);
    const std::uint32_t sum = checksum(stored);
    std::string bytes(kMagic, kMagicSize);
    bytes.append(reinterpret_cast<const char*>(&size), 4);
    bytes.append(reinterpret_cast<const char*>(&sum), 4);
    writeWhole(path, bytes + stored);
}

Submap readSubmap(const std::string& path)
{
    try
    {
        return fromFile(readWhole(path));
    }
    catch (const std::exception& e)
    {
        throw std::runtime_error("submap '" + path + "' cannot be used: " + e.what());
    }
}
}  // namespace taut
