#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace taut::bag
{
/** Bytes that somebody else keeps. */
struct Bytes
{
    const std::uint8_t* data = nullptr;
    std::size_t size = 0;
};

/** Reads numbers out of bytes, and never beyond them: throws std::runtime_error instead. */
class ByteReader
{
 public:
    explicit ByteReader(Bytes bytes, bool big_endian = false) : bytes_(bytes), swap_(big_endian) {}

    std::size_t position() const { return position_; }
    std::size_t remaining() const { return bytes_.size - position_; }

    /** The next bytes, not copied. */
    Bytes take(std::size_t count)
    {
        if (count > remaining()) throw std::runtime_error("it ends early");
        const Bytes taken{bytes_.data + position_, count};
        position_ += count;
        return taken;
    }

    template <class T>
    T number()
    {
        return numberAt<T>(take(sizeof(T)).data, swap_);
    }

    std::string text(std::size_t length)
    {
        const Bytes taken = take(length);
        return {reinterpret_cast<const char*>(taken.data), taken.size};
    }

    /** An unaligned number; the host is little endian, as all that taut runs on are. */
    template <class T>
    static T numberAt(const std::uint8_t* at, bool swap)
    {
        static_assert(std::is_arithmetic_v<T>);
        std::uint8_t raw[sizeof(T)];
        std::memcpy(raw, at, sizeof(T));
        if (swap) std::reverse(raw, raw + sizeof(T));
        T value;
        std::memcpy(&value, raw, sizeof(T));
        return value;
    }

 private:
    Bytes bytes_;
    std::size_t position_ = 0;
    bool swap_;
};
}  // namespace taut::bag
