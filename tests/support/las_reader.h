#pragma once

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace taut::test
{
/** The bytes of a LAS file, by the offsets of the specification 1.2. */
struct LasFile
{
    explicit LasFile(const std::string& path)
    {
        std::ifstream file(path, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(file), {});
    }

    template <class T>
    T at(std::size_t offset) const
    {
        T value{};
        if (offset + sizeof value <= bytes.size())
            std::memcpy(&value, bytes.data() + offset, sizeof value);
        return value;
    }

    std::size_t points() const { return at<std::uint32_t>(107); }
    std::size_t row(std::size_t i) const
    {
        return at<std::uint32_t>(96) + i * at<std::uint16_t>(105);
    }
    double coordinate(std::size_t i, std::size_t axis) const
    {
        return at<std::int32_t>(row(i) + 4 * axis) * at<double>(131 + 8 * axis) +
               at<double>(155 + 8 * axis);
    }
    std::uint16_t intensity(std::size_t i) const { return at<std::uint16_t>(row(i) + 12); }
    double time(std::size_t i) const { return at<double>(row(i) + 20); }
    double max(std::size_t axis) const { return at<double>(179 + 16 * axis); }
    double min(std::size_t axis) const { return at<double>(187 + 16 * axis); }

    std::string bytes;
};
}  // namespace taut::test
