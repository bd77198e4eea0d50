#include "OusterDescription.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "Decompress.h"

namespace taut::bag
{
namespace
{
const std::string kSuffix = "metadata";

std::string namespaceOf(const std::string& topic)
{
    return topic.substr(0, topic.rfind('/') + 1);
}

bool endsWith(const std::string& text, const std::string& end)
{
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/** Topics that may hold descriptions, those beside the LiDAR's first. */
std::vector<std::string> candidates(const std::vector<BagTopic>& topics, const BagTopic& lidar)
{
    std::vector<std::string> names;
    for (const BagTopic& topic : topics)
        if (topic.type == "std_msgs/String" && endsWith(topic.name, kSuffix))
            names.push_back(topic.name);
    std::stable_partition(
        names.begin(), names.end(),
        [&](const std::string& name) { return namespaceOf(name) == namespaceOf(lidar.name); });
    return names;
}

/** From the first message of a topic that is one; without, `cause` says why. */
std::optional<ouster::SensorInfo> readFrom(
    const std::string& path, const std::string& topic, std::string& cause)
{
    const auto reader = openBagReader(path, {});
    reader->choose({topic});
    while (const auto message = reader->next())
    {
        try
        {
            std::vector<std::uint8_t> buffer;
            return ouster::parseSensorInfo(
                WireReader(plainMessage(message->data, buffer), message->wire).text());
        }
        catch (const std::exception& e)  // also of the JSON library
        {
            if (cause.empty()) cause = topic + " does not describe an Ouster: " + e.what();
        }
    }
    return {};
}
}  // namespace

ouster::SensorInfo findOusterDescription(
    const std::string& path, const std::vector<BagTopic>& topics, const BagTopic& lidar,
    const std::string& given)
{
    if (!given.empty()) return ouster::loadSensorInfo(given);
    std::string cause;
    for (const std::string& topic : candidates(topics, lidar))
        if (auto info = readFrom(path, topic, cause)) return *info;
    std::filesystem::path beside = path;
    if (!beside.has_filename()) beside = beside.parent_path();
    beside.replace_extension(".json");
    if (std::filesystem::exists(beside)) return ouster::loadSensorInfo(beside.string());
    throw std::runtime_error(
        path + " has no description of the Ouster whose packets are on " + lidar.name + " (" +
        (cause.empty() ? "a topic of strings named metadata" : cause) +
        "): give it with --ouster-json");
}
}  // namespace taut::bag
