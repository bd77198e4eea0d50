#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "taut/rawlog/LogGrowth.h"

namespace taut
{
/** A file, compressed or not, read forward. It knows its position in the compressed file, tells a
 * file that was cut off from one that ended, and never returns less than was asked for. Its memory
 * does not depend on the file. */
class GzInput
{
 public:
    /** Throws std::runtime_error naming the file if it cannot be read, is no regular file, or is
     * empty. */
    explicit GzInput(const std::string& path);

    /** Of a file that grows: where it ends, `wait` is asked (also here, while it is empty). */
    GzInput(const std::string& path, WaitForGrowth wait);

    /** All `count` bytes; throws std::runtime_error at the end of the file and on damage. */
    void read(void* buffer, std::size_t count);

    /** Drops `count` bytes; throws as read() does. */
    void skip(std::size_t count);

    /** Bytes that come next; valid until the next call of anything here. */
    struct Bytes
    {
        const std::uint8_t* data;
        std::size_t size;
        bool file_ends;  //!< with these, and without damage
    };

    /** At least `count` of them (up to kPeekSize), or as many as can be read. */
    Bytes peek(std::size_t count);
    static constexpr std::size_t kPeekSize = 1u << 16;

    /** True if no byte is left. Throws std::runtime_error if the compressed stream is cut or
     * damaged there. */
    bool atEnd();

    /** True once the waiting was given up: that the file is not complete is no damage then. */
    bool isLeft() const { return growth_ == LogGrowth::Left; }

    std::uint64_t compressedPosition() const;
    std::uint64_t compressedSize() const { return size_; }

 private:
    bool fill();
    void waitForBegin();
    bool waitForMore();
    std::uint64_t sizeNow() const;
    [[noreturn]] void throwDamaged() const;
    bool isDamaged() const;

    struct Closer
    {
        void operator()(gzFile file) const { gzclose_r(file); }
    };
    std::string path_;
    WaitForGrowth wait_;
    LogGrowth growth_ = LogGrowth::More;
    std::uint64_t size_ = 0;
    std::unique_ptr<gzFile_s, Closer> file_;
    std::vector<std::uint8_t> buffer_;  // decompressed; [begin_, end_) is not read yet
    std::size_t begin_ = 0, end_ = 0;
};
}  // namespace taut
