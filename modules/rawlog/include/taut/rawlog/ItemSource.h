#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "taut/core/Imu.h"
#include "taut/core/Scan.h"
#include "taut/core/Warning.h"
#include "taut/rawlog/RawlogWriter.h"

namespace taut
{
/** What a recording of another format holds for taut: one reading of an IMU, one sweep as points,
 * or one sweep as the packets its sensor sent. */
using RecordedItem = std::variant<ImuSample, Scan, PacketScan>;

/** A recording of another format (packet capture, bag, folder), read item by item. Memory is
 * bounded by a few sweeps, never by the length of the recording. */
class ItemSource
{
 public:
    ItemSource() = default;
    virtual ~ItemSource() = default;
    ItemSource(const ItemSource&) = delete;
    ItemSource& operator=(const ItemSource&) = delete;

    /** The next item, nothing at the end of the recording. Items come in the order of the
     * recording; those of one sensor in the order of time. What is damaged on the way is left out
     * and reported through the WarningSink that the source was given: a warning always means that
     * a part of the recording could not be used. Throws std::runtime_error naming file and cause
     * if nothing after this can be read. */
    virtual std::optional<RecordedItem> next() = 0;

    /** Share of the recording that was read so far, 0 to 1: for a progress bar. */
    virtual double progress() const = 0;

    /** What was found out about the recording and used, though nothing is wrong with it (topics,
     * units, what a stamp means): one line each for the summary. Complete at the end. */
    virtual std::vector<std::string> findings() const { return {}; }

    /** True if the recording says that somebody undistorted its sweeps: their points get no times.
     */
    virtual bool isUndistorted() const { return false; }

    /** Usual time from the stamp of a sweep without times of its points until the recorder got it
     * [ns]; nothing if that is not known. Known after the first sweep. */
    virtual std::optional<Duration> arrivalDelay() const { return {}; }

    /** How often a part of the recording was left out so far, with a warning each. */
    virtual std::size_t leftOut() const { return 0; }

    /** False if nothing in the recording tells where the LiDAR is on the IMU: known from the begin.
     */
    virtual bool tellsPose() const { return true; }
};

/** Opens such a recording from its begin; it may be opened several times. Warnings of the reading
 * go to the sink. Throws std::runtime_error naming the recording. */
using OpenItems = std::function<std::unique_ptr<ItemSource>(const WarningSink&)>;
}  // namespace taut
