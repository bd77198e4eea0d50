#pragma once

#include <mrpt/io/CStream.h>
#include <zlib.h>

#include <cstdint>
#include <memory>
#include <string>

namespace taut
{
/** A file, compressed or not, as a stream for MRPT's archives. Unlike MRPT's own it knows its
 * position in the compressed file, tells a file that was cut off from one that ended, and never
 * returns less than was asked for. */
class GzInput : public mrpt::io::CStream
{
 public:
    /** Throws std::runtime_error naming the file if it cannot be read or is empty. */
    explicit GzInput(const std::string& path);

    /** All `count` bytes; throws std::runtime_error at the end of the file and on damage. */
    std::size_t Read(void* buffer, std::size_t count) override;

    /** True if no byte is left. Throws std::runtime_error if the compressed stream is cut or
     * damaged there. */
    bool atEnd();

    std::uint64_t compressedPosition() const;
    std::uint64_t compressedSize() const { return size_; }

    std::size_t Write(const void* buffer, std::size_t count) override;
    std::uint64_t Seek(std::int64_t offset, CStream::TSeekOrigin origin) override;
    std::uint64_t getTotalBytesCount() const override { return size_; }
    std::uint64_t getPosition() const override { return compressedPosition(); }
    std::string getStreamDescription() const override { return path_; }

 private:
    [[noreturn]] void throwDamaged() const;

    struct Closer
    {
        void operator()(gzFile file) const { gzclose_r(file); }
    };
    std::string path_;
    std::uint64_t size_ = 0;
    std::unique_ptr<gzFile_s, Closer> file_;
};
}  // namespace taut
