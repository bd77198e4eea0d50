#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/rawlog/RawlogSource.h"

namespace taut
{
/** An observation of a rawlog. */
struct LogEntry
{
    std::string class_name;  //!< without namespaces
    std::string label;       //!< valid UTF-8; of a class that taut does not use it may be empty
    mrpt::obs::CObservation::Ptr observation;  //!< null unless it is of a LiDAR or an IMU
    std::size_t bytes = 0;                     //!< of the observation in the file, if not null
};

/** Observations one by one: of a rawlog, or of what would be one after an import. */
class EntrySource
{
 public:
    virtual ~EntrySource() = default;

    /** The next one in the order of the file; none at the end or where the file cannot be read on.
     */
    virtual std::optional<LogEntry> next() = 0;

    /** Why the reading stopped before the end of the log; empty if it did not. */
    virtual std::string damage() const = 0;

    virtual std::uint64_t bytesRead() const = 0;
    virtual std::uint64_t bytesTotal() const = 0;

    /** As those of ItemSource. */
    virtual std::size_t leftOut() const { return 0; }
    virtual std::vector<std::string> findings() const { return {}; }
    virtual bool tellsPose() const { return true; }
};

/** The rawlog, or what RawlogConfig::open opens. Throws what they throw. */
std::unique_ptr<EntrySource> openEntries(const RawlogConfig& config, const WarningSink& warn);
}  // namespace taut
