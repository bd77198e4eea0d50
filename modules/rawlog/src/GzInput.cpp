#include "GzInput.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace taut
{
namespace
{
constexpr unsigned kBufferSize = 1u << 18;
}

GzInput::GzInput(const std::string& path) : path_(path)
{
    namespace fs = std::filesystem;
    std::error_code error;
    if (fs::is_directory(path, error))
        throw std::runtime_error("cannot read '" + path + "': it is a folder");
    file_.reset(gzopen(path.c_str(), "rb"));
    if (!file_) throw std::runtime_error("cannot open '" + path + "': " + std::strerror(errno));
    size_ = fs::file_size(path, error);
    if (error) throw std::runtime_error("cannot read '" + path + "': " + error.message());
    if (size_ == 0) throw std::runtime_error("'" + path + "' is empty");
    gzbuffer(file_.get(), kBufferSize);
}

std::size_t GzInput::Read(void* buffer, std::size_t count)
{
    auto* out = static_cast<char*>(buffer);
    for (std::size_t left = count; left > 0;)
    {
        const auto piece = static_cast<unsigned>(std::min<std::size_t>(left, 1u << 30));
        const int n = gzread(file_.get(), out, piece);
        if (n <= 0) throwDamaged();
        out += n;
        left -= static_cast<std::size_t>(n);
    }
    return count;
}

bool GzInput::atEnd()
{
    const int c = gzgetc(file_.get());
    if (c >= 0)
    {
        gzungetc(c, file_.get());
        return false;
    }
    int code = Z_OK;
    gzerror(file_.get(), &code);
    if (code != Z_OK && code != Z_STREAM_END) throwDamaged();
    return true;
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

std::size_t GzInput::Write(const void*, std::size_t)
{
    throw std::logic_error("GzInput is for reading only");
}

std::uint64_t GzInput::Seek(std::int64_t, CStream::TSeekOrigin)
{
    throw std::logic_error("GzInput cannot seek");
}
}  // namespace taut
