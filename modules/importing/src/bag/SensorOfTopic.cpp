#include "SensorOfTopic.h"

#include <map>

namespace taut::bag
{
namespace
{
constexpr std::size_t kMostNamed = 5;

std::string quoted(const std::set<std::string>& names)
{
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
    return text;
}

}  // namespace

void SensorOfTopic::learn(const std::vector<const RawSweep*>& sweeps)
{
    std::map<std::string, std::size_t> counts;
    for (const RawSweep* sweep : sweeps) counts[sweep->sensor]++;
    std::set<std::string> all, usual;
    bool any_matches = false;
    for (const auto& [name, count] : counts)
    {
        all.insert(name);
        if (count > 1 || counts.size() == 1) usual.insert(name);
        any_matches |= !expression_.empty() && name_.matches(name);
    }
    if (any_matches) return;
    if (!expression_.empty())
        throw std::runtime_error(
            "--lidar-id '" + expression_ + "' is no sensor of the topic; there are " + quoted(all));
    if (usual.empty()) usual = all;
    if (usual.size() > 1)
        throw std::runtime_error(
            "its sweeps are of several sensors (lidar_id or frame_id): " + quoted(usual) +
            "; --lidar-id chooses one");
    sensor_ = *usual.begin();
}

bool SensorOfTopic::isOf(const RawSweep& sweep) const
{
    return expression_.empty() ? sweep.sensor == sensor_ : name_.matches(sweep.sensor);
}

bool SensorOfTopic::takes(const RawSweep& sweep)
{
    if (isOf(sweep)) return true;
    others_++;
    if (names_of_others_.size() < kMostNamed) names_of_others_.insert(sweep.sensor);
    return false;
}

std::string SensorOfTopic::nameOfOthers() const
{
    return quoted(names_of_others_);
}
}  // namespace taut::bag
