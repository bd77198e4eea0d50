#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace taut
{
/** What stands before every MRPT object: the length of the class name (with the highest bit set),
 * the name, and the version of the class. After the object comes kObjectEnd. */
constexpr std::uint8_t kObjectEnd = 0x88;
constexpr std::size_t kLongestClassName = 120;
constexpr std::size_t kLongestHeader = 2 + kLongestClassName;

struct ObjectHeader
{
    std::string name;  //!< as in the file, with or without namespaces
    int version = 0;
    std::size_t bytes = 0;  //!< that it takes in the file

    /** The name without namespaces: "CObservationIMU". */
    std::string shortName() const { return name.substr(name.rfind(':') + 1); }
};

/** Nothing if no header of an object begins at `data`, of which `size` bytes are there. */
std::optional<ObjectHeader> parseObjectHeader(const std::uint8_t* data, std::size_t size);

/** True if the class is one of those of which a rawlog consists, by its name. */
bool isOfRawlogs(const ObjectHeader& header);
}  // namespace taut
