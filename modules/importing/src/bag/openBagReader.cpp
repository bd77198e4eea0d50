#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "BagFile.h"
#include "BagKind.h"
#include "BagReader.h"

namespace taut::bag
{
std::string plainType(std::string type)
{
    const std::size_t at = type.find("/msg/");
    if (at != std::string::npos) type.erase(at, 4);
    return type;
}

std::unique_ptr<BagReader> openBagReader(const std::string& path, const WarningSink& warn)
{
    if (std::filesystem::is_directory(path)) return openBagFolder(path, warn);
    BagFile file(path);
    std::vector<std::uint8_t> buffer;
    const Bytes head = file.read(std::min<std::uint64_t>(16, file.size()), buffer);
    switch (kindOf({reinterpret_cast<const char*>(head.data), head.size}))
    {
        case BagKind::Ros1:
            return openRos1Bag(path, warn);
        case BagKind::Mcap:
            return openMcap(path, warn);
        case BagKind::Sqlite3:
            return openSqlite3Bag(path, warn);
        case BagKind::Ros1Old:
            throw std::runtime_error(
                path +
                " is a bag of a format before 2.0; 'rosbag fix OLD.bag NEW.bag' converts it");
        case BagKind::Zstd:
            throw std::runtime_error(
                path + " is compressed as a whole; 'zstd -d' makes a bag of it");
        case BagKind::None:
            break;
    }
    throw std::runtime_error(path + " is no ROS bag");
}
}  // namespace taut::bag
