#pragma once

#include <list>
#include <memory>
#include <string>

#include "taut/core/Submap.h"

namespace taut
{
/** The submaps of a run: all of them on the disk, those that were used of late in memory. Not
 * thread-safe. */
class SubmapStore
{
 public:
    /** `folder` is made if it is not there. At most `in_memory` submaps are held. */
    explicit SubmapStore(std::string folder, std::size_t in_memory = 24);

    /** Submaps that are not in this folder are read from there. */
    void readAlsoFrom(std::string folder) { other_folder_ = std::move(folder); }

    /** Throws what writeSubmap() throws. */
    void add(Submap submap);

    /** Throws what readSubmap() throws. */
    std::shared_ptr<const Submap> at(VertexId id) const;

    /** `folder`/00012.tsm for submap 12. */
    std::string fileOf(VertexId id) const;

 private:
    void remember(std::shared_ptr<const Submap> submap) const;

    std::string folder_, other_folder_;
    std::size_t in_memory_;
    mutable std::list<std::shared_ptr<const Submap>> recent_;  // the last used one first
};
}  // namespace taut
