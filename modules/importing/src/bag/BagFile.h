#pragma once

#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "ByteReader.h"

namespace taut::bag
{
/** A file read from front to back in pieces, that knows how much is left of it. */
class BagFile
{
 public:
    /** Throws std::runtime_error naming the file if it cannot be read. */
    explicit BagFile(const std::string& path) : path_(path), in_(path, std::ios::binary)
    {
        in_.seekg(0, std::ios::end);
        if (!in_) throw std::runtime_error("cannot read " + path);
        size_ = static_cast<std::uint64_t>(in_.tellg());
        seek(0);
    }

    const std::string& path() const { return path_; }
    std::uint64_t size() const { return size_; }
    std::uint64_t position() const { return position_; }
    std::uint64_t remaining() const { return size_ - position_; }
    double progress() const
    {
        return size_ > 0 ? static_cast<double>(position_) / static_cast<double>(size_) : 0;
    }

    void seek(std::uint64_t position)
    {
        if (position > size_) throw std::runtime_error("the file ends early");
        in_.clear();
        in_.seekg(static_cast<std::streamoff>(position));
        position_ = position;
    }
    void skip(std::uint64_t count)
    {
        if (count > remaining()) throw std::runtime_error("the file ends early");
        if (count > 0) seek(position_ + count);
    }

    /** The next bytes, in a buffer of the caller's; valid until it is used again. */
    Bytes read(std::uint64_t count, std::vector<std::uint8_t>& buffer)
    {
        if (count > remaining()) throw std::runtime_error("the file ends early");
        buffer.resize(count);
        in_.read(reinterpret_cast<char*>(buffer.data()), static_cast<std::streamsize>(count));
        if (!in_) throw std::runtime_error("the file cannot be read further");
        position_ += count;
        return {buffer.data(), buffer.size()};
    }

    template <class T>
    T number()
    {
        std::uint8_t raw[sizeof(T)];
        if (sizeof(T) > remaining()) throw std::runtime_error("the file ends early");
        in_.read(reinterpret_cast<char*>(raw), sizeof(T));
        if (!in_) throw std::runtime_error("the file cannot be read further");
        position_ += sizeof(T);
        return ByteReader::numberAt<T>(raw, false);
    }

 private:
    std::string path_;
    std::ifstream in_;
    std::uint64_t size_ = 0, position_ = 0;
};
}  // namespace taut::bag
