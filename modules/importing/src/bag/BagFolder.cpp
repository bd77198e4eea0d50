#include "BagFolder.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "BagReader.h"
#include "taut/core/Yaml.h"

namespace taut::bag
{
namespace fs = std::filesystem;

namespace
{
std::vector<fs::path> partsOfMetadata(const fs::path& folder)
{
    std::vector<fs::path> parts;
    std::string cause;
    try
    {
        const YamlNode yaml = readYamlFile((folder / "metadata.yaml").string());
        const YamlNode* bag = yaml.find("rosbag2_bagfile_information");
        const YamlNode* list = bag != nullptr ? bag->find("relative_file_paths") : nullptr;
        for (const YamlNode& part : list != nullptr ? list->list : std::vector<YamlNode>())
        {
            const fs::path path = part.scalar;  // old recorders put the folder before it
            parts.push_back(folder / (fs::exists(folder / path) ? path : path.filename()));
        }
    }
    catch (const ConfigError& e)
    {
        cause = std::string(" (") + e.what() + ")";
    }
    if (parts.empty())
        throw std::runtime_error(
            (folder / "metadata.yaml").string() + " does not list the files of a bag" + cause +
            "; 'ros2 bag reindex' writes it anew, and without it the files are read in the order "
            "of their numbers");
    return parts;
}

/** "name_12.mcap" as ("name_", 12): for the order of "name_2" and "name_12". */
std::pair<std::string, unsigned long> numbered(const fs::path& path)
{
    const std::string stem = path.stem().string();
    std::size_t digits = stem.size();
    while (digits > 0 && stem.size() - digits < 9 && stem[digits - 1] >= '0' &&
           stem[digits - 1] <= '9')
        digits--;
    const std::string number = stem.substr(digits);
    return {stem.substr(0, digits), number.empty() ? 0 : std::stoul(number)};
}

/** The parts of a bag one after the other; one is open at a time. */
class BagFolder : public BagReader
{
 public:
    BagFolder(const fs::path& folder, WarningSink warn) : warn_(std::move(warn))
    {
        for (const fs::path& part : partsOfBag(folder))
        {
            if (fs::is_regular_file(part))  // a folder could be this one
                parts_.push_back(part);
            else if (warn_)
                warn_(
                    {0, "bag_file_missing",
                     part.string() +
                         " is a part of the bag, by metadata.yaml, and no file that is there"});
        }
        if (parts_.empty()) throw std::runtime_error("no part of the bag is in " + folder.string());
    }

    std::vector<BagTopic> topics() override
    {
        std::map<std::pair<std::string, std::string>, BagTopic> found;
        for (const fs::path& part : parts_)
            for (BagTopic& topic : openBagReader(part.string(), {})->topics())
            {
                const bool empty = topic.empty;
                const auto it =
                    found.emplace(std::pair(topic.name, topic.type), std::move(topic)).first;
                it->second.empty &= empty;
            }
        std::vector<BagTopic> topics;
        for (auto& [key, topic] : found) topics.push_back(std::move(topic));
        return topics;
    }

    void choose(const std::vector<std::string>& topics) override { chosen_ = topics; }

    std::optional<BagMessage> next() override
    {
        while (true)
        {
            if (reader_)
                if (auto message = reader_->next()) return message;
            if (opened_ == parts_.size()) return {};
            reader_ = openBagReader(parts_[opened_++].string(), warn_);
            reader_->choose(chosen_);
        }
    }

    double progress() const override
    {
        if (!reader_) return 0;
        return (static_cast<double>(opened_ - 1) + reader_->progress()) /
               static_cast<double>(parts_.size());
    }

 private:
    WarningSink warn_;
    std::vector<fs::path> parts_;
    std::vector<std::string> chosen_;
    std::unique_ptr<BagReader> reader_;
    std::size_t opened_ = 0;
};
}  // namespace

bool hasBagName(const fs::path& file)
{
    static const std::set<std::string> endings{".bag", ".mcap", ".db3", ".zstd"};
    return endings.count(file.extension().string()) > 0;
}

std::vector<fs::path> partsOfBag(const fs::path& folder)
{
    if (fs::exists(folder / "metadata.yaml")) return partsOfMetadata(folder);
    std::vector<fs::path> parts;
    for (const auto& entry : fs::directory_iterator(folder))
        if (hasBagName(entry.path()) && entry.is_regular_file()) parts.push_back(entry.path());
    std::sort(
        parts.begin(), parts.end(),
        [](const fs::path& a, const fs::path& b)
        { return std::pair(numbered(a), a) < std::pair(numbered(b), b); });
    return parts;
}

std::unique_ptr<BagReader> openBagFolder(const std::string& path, const WarningSink& warn)
{
    return std::make_unique<BagFolder>(path, warn);
}
}  // namespace taut::bag
