#pragma once

#include "ByteReader.h"

namespace taut::bag
{
/** How ROS puts a message into bytes. */
enum class Wire
{
    Ros1,  //!< packed, little endian
    Cdr    //!< aligned, either endian, with an encapsulation header (OMG DDSI-RTPS 10.2.1)
};

/** Reads the values of a message one after the other, the same way for both wires: the layout of a
 * message is written once. Throws std::runtime_error where the bytes cannot be such values. */
class WireReader
{
 public:
    WireReader(Bytes message, Wire wire) : wire_(wire), reader_(body(message, wire)) {}

    Wire wire() const { return wire_; }

    template <class T>
    T number()
    {
        align(sizeof(T));
        return reader_.number<T>();
    }

    /** A string, without the zero that CDR ends it with. */
    std::string text()
    {
        std::string s = reader_.text(number<std::uint32_t>());
        if (wire_ == Wire::Cdr && !s.empty() && s.back() == '\0') s.pop_back();
        return s;
    }

    /** Length of a sequence whose elements have at least so many bytes each. */
    std::size_t sequence(std::size_t smallest_element)
    {
        const std::size_t count = number<std::uint32_t>();
        if (count > reader_.remaining() / smallest_element)
            throw std::runtime_error("it ends early");
        return count;
    }

    /** A sequence of bytes, not copied. */
    Bytes bytes() { return reader_.take(number<std::uint32_t>()); }

    /** An array of so many bytes, not copied. */
    Bytes array(std::size_t count) { return reader_.take(count); }

 private:
    static constexpr std::size_t kEncapsulation = 4;

    static ByteReader body(Bytes message, Wire wire)
    {
        if (wire == Wire::Ros1) return ByteReader(message);
        if (message.size < kEncapsulation) throw std::runtime_error("it ends early");
        // Plain CDR is 0x0000 (big endian) or 0x0001 (little endian); two bytes of options follow.
        if (message.data[0] != 0 || message.data[1] > 1)
            throw std::runtime_error("its encapsulation is not plain CDR");
        return ByteReader(
            {message.data + kEncapsulation, message.size - kEncapsulation}, message.data[1] == 0);
    }

    void align(std::size_t size)
    {
        if (wire_ == Wire::Cdr) reader_.take((size - reader_.position() % size) % size);
    }

    Wire wire_;
    ByteReader reader_;
};
}  // namespace taut::bag
