#include "TopicChoice.h"

#include <algorithm>

#include "taut/core/ChoiceNeeded.h"
#include "taut/core/NameExpression.h"

namespace taut::bag
{
std::vector<BagTopic> topicsOf(BagReader& reader)
{
    std::vector<BagTopic> topics;
    for (BagTopic& topic : reader.topics())
    {
        const auto same = std::find_if(
            topics.begin(), topics.end(),
            [&](const BagTopic& other)
            { return other.name == topic.name && other.type == topic.type; });
        if (same == topics.end())
            topics.push_back(std::move(topic));
        else
            same->empty &= topic.empty;
    }
    return topics;
}

std::string describe(const std::vector<BagTopic>& topics)
{
    std::string text;
    for (const BagTopic& topic : topics)
        text += (text.empty() ? "" : ", ") + topic.name + " (" +
                (topic.type.empty() ? "no ROS message" : topic.type) + ")";
    return text.empty() ? "none" : text;
}

std::vector<BagTopic> matching(
    const std::vector<BagTopic>& topics, const std::vector<std::string>& types,
    const std::string& expression, const std::string& option)
{
    const NameExpression name(option, expression);
    std::vector<BagTopic> found;
    for (const BagTopic& topic : topics)
        if (std::find(types.begin(), types.end(), topic.type) != types.end() &&
            name.matches(topic.name))
            found.push_back(topic);
    return found;
}

std::optional<BagTopic> chooseTopic(
    const std::vector<BagTopic>& topics, const std::vector<std::string>& types,
    const std::string& expression, const std::string& option)
{
    std::vector<BagTopic> found = matching(topics, types, expression, option);
    if (found.size() > 1)
        found.erase(
            std::remove_if(found.begin(), found.end(), [](const BagTopic& t) { return t.empty; }),
            found.end());
    if (found.size() > 1)
        throw ChoiceNeeded(
            "several topics could be meant: " + describe(found), option,
            expressionFor(found.front().name));
    if (found.empty() && !expression.empty())
        throw std::runtime_error(
            option + " '" + expression +
            "' is no topic that can be read; there are: " + describe(topics));
    return found.empty() ? std::nullopt : std::optional(found.front());
}
}  // namespace taut::bag
