#pragma once

#include <string>

namespace taut::bag
{
/** What a file is by its first bytes. */
enum class BagKind
{
    None,
    Ros1,
    Ros1Old,  //!< before format 2.0
    Mcap,
    Sqlite3,
    Zstd  //!< a file that was compressed as a whole
};

inline BagKind kindOf(const std::string& head)
{
    const auto begins = [&](const std::string& magic)
    { return head.compare(0, magic.size(), magic) == 0; };
    if (begins("#ROSBAG V2.0\n")) return BagKind::Ros1;
    if (begins("#ROSBAG V") || begins("#ROSRECORD V")) return BagKind::Ros1Old;
    if (begins(std::string("\x89MCAP0\r\n", 8))) return BagKind::Mcap;
    if (begins(std::string("SQLite format 3\0", 16))) return BagKind::Sqlite3;
    if (begins("\x28\xB5\x2F\xFD")) return BagKind::Zstd;
    return BagKind::None;
}
}  // namespace taut::bag
