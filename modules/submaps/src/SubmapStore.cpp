#include "taut/submaps/SubmapStore.h"

#include <algorithm>
#include <filesystem>

#include "taut/core/format.h"
#include "taut/submaps/SubmapFile.h"

namespace taut
{
SubmapStore::SubmapStore(std::string folder, std::size_t in_memory)
    : folder_(std::move(folder)), in_memory_(in_memory)
{
    std::filesystem::create_directories(folder_);
}

std::string SubmapStore::fileOf(VertexId id) const
{
    const std::string name = format("/%05lld.tsm", static_cast<long long>(id));
    if (!other_folder_.empty() && !std::filesystem::exists(folder_ + name) &&
        std::filesystem::exists(other_folder_ + name))
        return other_folder_ + name;
    return folder_ + name;
}

void SubmapStore::add(Submap submap)
{
    writeSubmap(folder_ + format("/%05lld.tsm", static_cast<long long>(submap.id)), submap);
    remember(std::make_shared<const Submap>(std::move(submap)));
}

std::shared_ptr<const Submap> SubmapStore::at(VertexId id) const
{
    const auto found = std::find_if(
        recent_.begin(), recent_.end(), [id](const auto& submap) { return submap->id == id; });
    if (found == recent_.end())
        remember(std::make_shared<const Submap>(readSubmap(fileOf(id))));
    else
        recent_.splice(recent_.begin(), recent_, found);
    return recent_.front();
}

void SubmapStore::remember(std::shared_ptr<const Submap> submap) const
{
    recent_.push_front(std::move(submap));
    if (recent_.size() > in_memory_) recent_.pop_back();
}
}  // namespace taut
