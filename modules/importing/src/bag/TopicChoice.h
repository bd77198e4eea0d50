#pragma once

#include <optional>
#include <string>
#include <vector>

#include "BagReader.h"

namespace taut::bag
{
/** The topics of one of these types whose name matches the whole expression; an empty expression
 * matches all. Throws std::runtime_error if it is none. */
std::vector<BagTopic> matching(
    const std::vector<BagTopic>& topics, const std::vector<std::string>& types,
    const std::string& expression, const std::string& option);

/** The topic of one of these types whose name matches the whole expression; without an expression,
 * the only one there. Nothing if there is none and no expression asks for one. Throws
 * std::runtime_error, listing what there is, if it is ambiguous or what was asked for is not there.
 * `option` is for messages: "--lidar-topic". */
std::optional<BagTopic> chooseTopic(
    const std::vector<BagTopic>& topics, const std::vector<std::string>& types,
    const std::string& expression, const std::string& option);

/** The topics of a bag, those once that several connections wrote to. */
std::vector<BagTopic> topicsOf(BagReader& reader);

/** "/a (pkg/A), /b (pkg/B)", or "none". */
std::string describe(const std::vector<BagTopic>& topics);
}  // namespace taut::bag
