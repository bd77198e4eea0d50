#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "taut/rawlog/RawlogSource.h"

namespace taut
{
/** A RawlogSource that reads ahead in a thread of its own, so that decompression and decoding
 * overlap with the estimation. Gives exactly what the source gives, in the same order: warnings
 * come from within next(), in the caller's thread, between the same measurements; exceptions as
 * well. */
class PrefetchedRawlog : public MeasurementStream
{
 public:
    /** Throws what RawlogSource throws. At most `max_scans` (at least 1) are held. */
    explicit PrefetchedRawlog(
        const RawlogConfig& config, WarningSink warn = {}, std::size_t max_scans = 8);
    /** Stops the reading, wherever it is. */
    ~PrefetchedRawlog() override;

    std::optional<Measurement> next() override;
    StreamProgress progress() const override;
    bool incomplete() const override;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace taut
