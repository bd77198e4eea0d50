#include "EntrySource.h"

#include <filesystem>
#include <utility>

#include "ObservationReader.h"
#include "taut/rawlog/toObservation.h"

namespace taut
{
namespace fs = std::filesystem;

namespace
{
std::uint64_t sizeOf(const fs::path& path)
{
    std::error_code error;
    if (!fs::is_directory(path, error))
    {
        const auto size = fs::file_size(path, error);
        return error ? 0 : size;
    }
    std::uint64_t sum = 0;
    for (const auto& entry : fs::recursive_directory_iterator(
             path, fs::directory_options::skip_permission_denied, error))
        if (std::error_code failed; entry.is_regular_file(failed))
            if (const auto size = entry.file_size(failed); !failed) sum += size;
    return sum;
}

std::size_t bytesOf(const ImuSample&)
{
    return 2000;  // a CObservationIMU holds 40 values and as many flags
}

std::size_t bytesOf(const Scan& scan)
{
    return 24 * scan.points.size();
}

std::size_t bytesOf(const PacketScan& scan)
{
    return velodyne::kPacketBytes * scan.packets.size();
}

/** Items of another format, as the observations that an import would write. */
class ItemEntries : public EntrySource
{
 public:
    ItemEntries(const std::string& path, std::unique_ptr<ItemSource> items)
        : items_(std::move(items)), bytes_(sizeOf(path))
    {
    }

    std::optional<LogEntry> next() override
    {
        const auto item = items_->next();
        if (!item) return {};
        return std::visit([this](const auto& i) { return entryOf(i); }, *item);
    }

    std::string damage() const override { return {}; }  // sources warn of it themselves
    std::uint64_t bytesRead() const override
    {
        return static_cast<std::uint64_t>(items_->progress() * static_cast<double>(bytes_));
    }
    std::uint64_t bytesTotal() const override { return bytes_; }
    std::size_t leftOut() const override { return items_->leftOut(); }
    std::vector<std::string> findings() const override { return items_->findings(); }
    bool tellsPose() const override { return items_->tellsPose(); }

 private:
    template <class Item>
    LogEntry entryOf(const Item& item) const
    {
        LogEntry entry;
        entry.observation = toObservation(item, RawlogWriterConfig{});
        entry.label = entry.observation->sensorLabel;
        entry.class_name = entry.observation->GetRuntimeClass()->className;
        if (const auto colon = entry.class_name.rfind(':'); colon != std::string::npos)
            entry.class_name.erase(0, colon + 1);
        entry.bytes = bytesOf(item);
        return entry;
    }

    std::unique_ptr<ItemSource> items_;
    std::uint64_t bytes_;
};
}  // namespace

std::unique_ptr<EntrySource> openEntries(const RawlogConfig& config, const WarningSink& warn)
{
    if (!config.open)
        return std::make_unique<ObservationReader>(config.path, config.wait_for_growth);
    return std::make_unique<ItemEntries>(config.path, config.open(warn));
}
}  // namespace taut
