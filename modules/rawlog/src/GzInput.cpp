#include "GzInput.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace taut
{
namespace
{
constexpr unsigned kCompressedBuffer = 1u << 18;
constexpr std::uint64_t kMagicSize = 2;
constexpr std::size_t kPiece = 1u << 14;  // small: a piece with damage in it is lost whole
}  // namespace

GzInput::GzInput(const std::string& path) : GzInput(path, {}) {}

GzInput::GzInput(const std::string& path, WaitForGrowth wait)
    : path_(path), wait_(std::move(wait)), buffer_(kPeekSize + kPiece)
{
    namespace fs = std::filesystem;
    std::error_code error;
    const auto type = fs::status(path, error).type();
    if (type == fs::file_type::directory)
        throw std::runtime_error("cannot read '" + path + "': it is a folder");
    // Opening a pipe would wait for somebody who writes to it.
    if (type != fs::file_type::regular && type != fs::file_type::not_found && !error)
        throw std::runtime_error("cannot read '" + path + "': it is not a regular file");
    file_.reset(gzopen(path.c_str(), "rb"));
    if (!file_) throw std::runtime_error("cannot open '" + path + "': " + std::strerror(errno));
    size_ = sizeNow();
    waitForBegin();
    if (size_ == 0) throw std::runtime_error("'" + path + "' is empty");
    gzbuffer(file_.get(), kCompressedBuffer);
}

void GzInput::read(void* buffer, std::size_t count)
{
    for (auto* out = static_cast<std::uint8_t*>(buffer); count > 0;)
    {
        if (begin_ == end_ && !fill()) throwDamaged();
        const std::size_t n = std::min(count, end_ - begin_);
        std::memcpy(out, buffer_.data() + begin_, n);
        begin_ += n;
        out += n;
        count -= n;
    }
}

void GzInput::skip(std::size_t count)
{
    while (count > 0)
    {
        if (begin_ == end_ && !fill()) throwDamaged();
        const std::size_t n = std::min(count, end_ - begin_);
        begin_ += n;
        count -= n;
    }
}

GzInput::Bytes GzInput::peek(std::size_t count)
{
    bool more = true;
    while (more && end_ - begin_ < std::min(count, kPeekSize)) more = fill();
    return {buffer_.data() + begin_, end_ - begin_, !more && !isDamaged()};
}

bool GzInput::atEnd()
{
    if (peek(1).size > 0) return false;
    if (isDamaged()) throwDamaged();
    return true;
}

/* One more piece into the buffer; false where the file cannot be read on. */
bool GzInput::fill()
{
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    const auto room = static_cast<unsigned>(std::min(kPiece, buffer_.size() - end_));
    int n = gzread(file_.get(), buffer_.data() + end_, room);
    while (n <= 0 && waitForMore()) n = gzread(file_.get(), buffer_.data() + end_, room);
    if (n > 0) end_ += static_cast<std::size_t>(n);
    return n > 0;
}

/* By its first bytes a file is told to be compressed or not. */
void GzInput::waitForBegin()
{
    while (wait_ && growth_ == LogGrowth::More && size_ < kMagicSize)
    {
        growth_ = wait_();
        size_ = sizeNow();
    }
}

/* True if there may be more by now. What comes after the last answer of the one who is asked is not
 * missed: it looks once more. */
bool GzInput::waitForMore()
{
    int code = Z_OK;
    gzerror(file_.get(), &code);
    const bool at_end = code == Z_OK || code == Z_BUF_ERROR || code == Z_STREAM_END;
    if (!wait_ || !at_end || growth_ != LogGrowth::More) return false;
    growth_ = wait_();
    size_ = sizeNow();
    gzclearerr(file_.get());
    return true;
}

std::uint64_t GzInput::sizeNow() const
{
    std::error_code error;
    const auto size = std::filesystem::file_size(path_, error);
    if (error) throw std::runtime_error("cannot read '" + path_ + "': " + error.message());
    return size;
}

bool GzInput::isDamaged() const
{
    int code = Z_OK;
    gzerror(file_.get(), &code);
    return code != Z_OK && code != Z_STREAM_END && !(isLeft() && code == Z_BUF_ERROR);
}

std::uint64_t GzInput::compressedPosition() const
{
    const auto position = gzoffset(file_.get());
    return position < 0 ? size_ : static_cast<std::uint64_t>(position);
}

void GzInput::throwDamaged() const
{
    int code = Z_OK;
    const char* text = gzerror(file_.get(), &code);
    if (code == Z_OK || code == Z_BUF_ERROR || code == Z_STREAM_END)
        throw std::runtime_error("the file ends in the middle of an object");
    throw std::runtime_error(std::string("the compressed data is damaged (") + text + ")");
}
}  // namespace taut
