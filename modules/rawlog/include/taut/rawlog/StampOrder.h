#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/Time.h"

namespace taut
{
/** Judges the stamps of two sensors by their neighbours, those after them too, before anything is
 * left out for them: one wrong stamp costs one measurement, not all that follow. Looks a second
 * ahead, and for at least three stamps of the same sensor; while all is well, nothing changes the
 * order in which measurements come. */
class StampOrder
{
 public:
    enum class Sensor
    {
        Imu,
        Lidar
    };

    enum class Judge
    {
        Later,  //!< always by those after it too
        AtOnce  //!< a stamp within a second after the one before is good; the others later
    };

    explicit StampOrder(Judge judge = Judge::Later) : judge_(judge) {}

    enum class Verdict
    {
        Good,     //!< later than the one before, as far as can be helped
        Outlier,  //!< seconds away from those around it: to be left out
        Sorted,   //!< of an IMU, up to a second late in the file, and in its place now
        SetBack   //!< the first after the clock was set back by more than half a second
    };

    struct Judged
    {
        std::size_t id = 0;  //!< as push() gave it
        Verdict verdict = Verdict::Good;
        /** To be added to its stamp: what the sensor's clock was set back by. The same for both
         * sensors where their clocks were set back by the same within half a second. */
        Duration shift = 0;
        /** How far from its neighbours, how late, or set back by how much. */
        Duration amount = 0;
    };

    /** The stamps in the order of the file; gives ids from 0. */
    std::size_t push(Sensor sensor, Time t);

    /** Whether enough is known of what follows to judge the next one. */
    bool ready() const;

    /** The next one, also if it is not ready(): for the end of the file. Nothing if there is none.
     */
    std::optional<Judged> pop();

    /** The usual interval of the stamps around the next one; nothing where there are too few. */
    std::optional<Duration> interval(Sensor sensor) const;

    /** How much time went by in the stamps pushed, whatever some of them say. */
    Duration elapsed() const;

 private:
    struct Entry
    {
        std::size_t id = 0;
        Sensor sensor = Sensor::Imu;
        Time t = 0;
        std::array<Duration, 2> elapsed{};  // of both sensors when it came
        bool descends = false;              // earlier than one before it that was pending then
        bool taken = false;
    };
    using Entries = std::vector<Entry*>;

    struct Stream
    {
        std::deque<Time> history;          // given out: the last second by the present clock
        std::optional<Time> last;          // of these
        std::optional<Time> pushed, peak;  // the latest in the file; the highest pending
        Duration elapsed = 0, shift = 0;
        std::size_t pending = 0, descents = 0, after_descent = 0;
    };

    Stream& streamOf(Sensor sensor) { return streams_[static_cast<std::size_t>(sensor)]; }
    bool follows(const Entry& front) const;
    Entries pendingOf(Sensor sensor);
    bool isOutlier(const Entries& own) const;
    bool isSetBack(const Entries& own, std::size_t at, Time peak) const;
    bool stepsAsTheOther(const Entry& entry) const;
    Duration stepOf(const Entry& entry) const;
    Duration behindTheOther(Sensor sensor) const;
    Entry* lateOne(const Entries& own) const;
    Judged give(Entry& entry, Verdict verdict, Duration amount);

    Judge judge_;
    std::deque<Entry> queue_;
    std::array<Stream, 2> streams_;
    std::size_t next_id_ = 0;
};

/** What to say of one that is not good: kind of the warning and text; `what` as in "a scan". */
struct StampFinding
{
    std::string kind, text;
};
StampFinding findingOf(const StampOrder::Judged& judged, const std::string& what);
}  // namespace taut
