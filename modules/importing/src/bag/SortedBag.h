#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "BagReader.h"

namespace taut::bag
{
/** The messages of a LiDAR's topic and of an IMU's in the order of time, as a player gives them,
 * whatever their order in the file: each topic has a reader of its own, so that memory does not
 * grow with what lies between them. By the recorder's times; by the stamps in the messages where
 * the recorder's times do not go on as these do (a script that wrote the bag). A clock that was set
 * back puts nothing out of order.
 *
 * Compares the clocks of both: where the recorder got messages of one much longer after their
 * stamps than those of the other, these differ ("clock_offset"). */
class SortedBag
{
 public:
    /** `reader` is one of the recording at `path`; it reads the LiDAR's topic and reports damage of
     * the file. `lidar_clock_offset` is to be added to the LiDAR's stamps [ns]. */
    SortedBag(
        std::string path, std::unique_ptr<BagReader> reader, const BagTopic& lidar,
        const std::optional<BagTopic>& imu, Duration lidar_clock_offset, WarningSink warn);

    /** The next message; valid until it is called again. */
    std::optional<BagMessage> next();

    double progress() const;  //!< 0 to 1
    const std::vector<std::string>& findings() const { return findings_; }

 private:
    struct Held
    {
        Time received = 0;
        std::optional<Time> stamp;
        Wire wire = Wire::Cdr;
        std::vector<std::uint8_t> data;
    };
    struct Feed
    {
        BagTopic topic;
        std::unique_ptr<BagReader> reader;
        std::deque<Held> ahead;
        std::size_t bytes = 0;     // of those ahead
        std::optional<Time> last;  // clock of the one given last
        Duration elapsed = 0;      // since the first, by a clock that never goes back
        bool ended = false;
    };

    void addFeed(const BagTopic& topic, std::unique_ptr<BagReader> reader);
    void readOne(Feed& feed) const;
    void learn();
    void compareClocks();
    Time clockOf(const Held& held) const;
    Time dueAt(const Feed& feed) const;
    Duration stepTo(const Feed& feed) const;

    std::string path_;
    WarningSink warn_;
    Duration lidar_clock_offset_;
    std::vector<Feed> feeds_;  // of the LiDAR, of the IMU
    Time begin_ = 0;
    bool learned_ = false, by_stamp_ = false;
    Held given_;
    std::vector<std::string> findings_;
};
}  // namespace taut::bag
