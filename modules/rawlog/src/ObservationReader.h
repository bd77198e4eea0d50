#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "EntrySource.h"
#include "GzInput.h"
#include "ObjectHeader.h"

namespace taut
{
/** Gives the observations of a rawlog one by one, whichever of the two formats it has. Memory is
 * bounded by what the file holds and by the size of a scan, whatever sizes are written in it. */
class ObservationReader : public EntrySource
{
 public:
    /** Throws std::runtime_error naming the file if it is missing, empty or no rawlog. */
    explicit ObservationReader(const std::string& path, WaitForGrowth wait = {});

    /** The next one in the order of the file; none at the end or where the file cannot be read on.
     */
    std::optional<LogEntry> next() override;

    /** Why the reading stopped before the end of the log; empty if it did not. */
    std::string damage() const override { return damage_; }

    std::uint64_t bytesRead() const override { return input_.compressedPosition(); }
    std::uint64_t bytesTotal() const override { return input_.compressedSize(); }

 private:
    std::optional<LogEntry> read();
    std::optional<LogEntry> readObject();
    void beginFrame(const ObjectHeader& header);
    void endFrame();
    LogEntry readObservation(const ObjectHeader& header);

    GzInput input_;
    std::optional<LogEntry> first_;  // read on opening
    std::string damage_;
    std::size_t objects_ = 0;
    std::optional<std::uint32_t> frame_;  // observations left of the sensory frame that is open
    bool finished_ = false;
};
}  // namespace taut
