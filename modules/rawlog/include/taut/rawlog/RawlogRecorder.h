#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "taut/rawlog/LogGrowth.h"

namespace mrpt::obs
{
class CObservation;
}

namespace taut
{
/** Writes observations to a rawlog as they come. What was written can be read at once, also if the
 * program is killed. Thread-safe. */
class RawlogRecorder
{
 public:
    /** `gz_level` as of zlib: 1 (fast) to 9; 0: not compressed. Throws std::runtime_error naming
     * the file if it cannot be written or is there already: no recording is written over. */
    RawlogRecorder(const std::string& path, int gz_level);
    /** Closes it, and tells nobody if that fails. */
    ~RawlogRecorder();
    RawlogRecorder(const RawlogRecorder&) = delete;
    RawlogRecorder& operator=(const RawlogRecorder&) = delete;

    /** Throws std::runtime_error if the disk does not take it, and std::logic_error after close().
     */
    void write(const mrpt::obs::CObservation& observation);

    /** No more comes. Throws std::runtime_error if the disk does not take what is left. Does
     * nothing the second time. */
    void close();

    std::size_t observations() const;  //!< written
    std::uint64_t bytes() const;       //!< of these, before compression

    /** For one reader of the file (RawlogConfig::wait_for_growth): waits up to 0.1 s for what was
     * not told yet. Complete after close(). */
    LogGrowth waitForGrowth();

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace taut
