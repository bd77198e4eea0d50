#include "SortedBag.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "Decompress.h"
#include "Messages.h"
#include "taut/core/format.h"

namespace taut::bag
{
namespace
{
constexpr Time kLatest = 4'600'000'000'000'000'000;  // ns: beyond what a stamp can be
constexpr std::size_t kJudged = 200, kFewest = 5;    // messages of a topic that tell its clocks
constexpr std::size_t kMostBytes = 20'000'000;       // of these, but for the fewest
constexpr double kSteadyPace = 5;                    // of the recorder's clock by the stamps
constexpr Duration kShortest = 100'000'000;          // that tells a pace
constexpr Duration kLargestDelay = 1'000'000'000;    // from the stamp to the recorder
constexpr Duration kNear = 500'000'000;

/** Of the header that a message begins with; nothing if its type has none. */
std::optional<Time> headerStamp(const BagTopic& topic, const BagMessage& message)
{
    if (isOusterPacketType(topic.type)) return {};
    try
    {
        std::vector<std::uint8_t> buffer;
        const Time stamp = readStamp({plainMessage(message.data, buffer), message.wire});
        return stamp == 0 ? std::nullopt : std::optional(std::clamp<Time>(stamp, 0, kLatest));
    }
    catch (const std::runtime_error&)
    {
        return {};
    }
}

Duration median(std::vector<Duration> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/** How much later the last third of them is than the first, whatever single ones say. */
Duration spanOf(const std::vector<Time>& times)
{
    const auto third = static_cast<std::ptrdiff_t>((times.size() + 2) / 3);
    return median({times.end() - third, times.end()}) -
           median({times.begin(), times.begin() + third});
}

/** What usually makes clocks differ by so much. */
std::string causeOf(Duration ahead)
{
    for (const auto& [seconds, cause] :
         {std::pair(37, "TAI is ahead of UTC by"), std::pair(18, "GPS time is ahead of UTC by")})
        if (std::abs(ahead - seconds * Duration{1'000'000'000}) < kNear)
            return format(", which is what %s: %d s exactly", cause, seconds);
    return "";
}
}  // namespace

SortedBag::SortedBag(
    std::string path, std::unique_ptr<BagReader> reader, const BagTopic& lidar,
    const std::optional<BagTopic>& imu, Duration lidar_clock_offset, WarningSink warn)
    : path_(std::move(path)), warn_(std::move(warn)), lidar_clock_offset_(lidar_clock_offset)
{
    addFeed(lidar, std::move(reader));
    if (imu) addFeed(*imu, openBagReader(path_, {}));  // what is damaged, the first one tells
}

void SortedBag::addFeed(const BagTopic& topic, std::unique_ptr<BagReader> reader)
{
    reader->choose({topic.name});
    feeds_.emplace_back();
    feeds_.back().topic = topic;
    feeds_.back().reader = std::move(reader);
}

void SortedBag::readOne(Feed& feed) const
{
    const auto message = feed.reader->next();
    feed.ended = !message;
    if (!message) return;
    const bool wanted = !learned_ || by_stamp_;
    feed.ahead.push_back(
        {std::clamp<Time>(message->received, 0, kLatest),
         wanted ? headerStamp(feed.topic, *message) : std::nullopt,
         message->wire,
         {message->data.data, message->data.data + message->data.size}});
    feed.bytes += message->data.size;
}

std::optional<BagMessage> SortedBag::next()
{
    if (!std::exchange(learned_, true)) learn();
    Feed* first = nullptr;
    for (Feed& feed : feeds_)
    {
        // One more than is given: its time may be wrong.
        while (!feed.ended && feed.ahead.size() < 2) readOne(feed);
        if (!feed.ahead.empty() && (first == nullptr || dueAt(feed) <= dueAt(*first)))
            first = &feed;
    }
    if (first == nullptr) return {};
    const Duration step = stepTo(*first);
    first->elapsed += std::max<Duration>(step, 0);
    first->last = first->last.value_or(begin_) + step;
    given_ = std::move(first->ahead.front());
    first->ahead.pop_front();
    first->bytes -= given_.data.size();
    return BagMessage{
        first->topic.name, given_.wire, given_.received, {given_.data.data(), given_.data.size()}};
}

double SortedBag::progress() const
{
    double sum = 0;
    for (const Feed& feed : feeds_) sum += feed.reader->progress();
    return sum / static_cast<double>(feeds_.size());
}

Time SortedBag::clockOf(const Held& held) const
{
    return by_stamp_ && held.stamp ? *held.stamp : held.received;
}

/** From the message given last to the next. */
Duration SortedBag::stepTo(const Feed& feed) const
{
    Time next = clockOf(feed.ahead.front());
    if (feed.ahead.size() > 1) next = std::min(next, clockOf(feed.ahead[1]));
    return next - feed.last.value_or(begin_);
}

/** When its next message is to be given. */
Time SortedBag::dueAt(const Feed& feed) const
{
    return feed.elapsed + std::max<Duration>(stepTo(feed), 0);
}

void SortedBag::learn()
{
    learned_ = false;  // stamps are read until it is known who counts
    for (Feed& feed : feeds_)
        while (!feed.ended && (feed.ahead.size() < kFewest ||
                               (feed.ahead.size() < kJudged && feed.bytes < kMostBytes)))
            readOne(feed);
    bool steady = true;
    for (const Feed& feed : feeds_)
    {
        std::vector<Time> stamps, received;
        for (const Held& held : feed.ahead)
        {
            if (!held.stamp) continue;
            stamps.push_back(*held.stamp);
            received.push_back(held.received);
        }
        if (stamps.size() < kFewest) continue;
        const auto by_stamps = static_cast<double>(spanOf(stamps));
        const auto pace = static_cast<double>(spanOf(received)) / by_stamps;
        if (by_stamps >= static_cast<double>(kShortest))
            steady &= pace > 1 / kSteadyPace && pace < kSteadyPace;
    }
    by_stamp_ = !steady && feeds_.size() > 1;
    learned_ = true;
    if (by_stamp_)
        findings_.emplace_back(
            "order: by the stamps of the messages, for the times of the recorder do not go on as "
            "these do");
    else
        compareClocks();
    begin_ = kLatest;
    for (const Feed& feed : feeds_)
        for (std::size_t i = 0; i < std::min<std::size_t>(2, feed.ahead.size()); i++)
            begin_ = std::min(begin_, clockOf(feed.ahead[i]));
}

void SortedBag::compareClocks()
{
    std::vector<Duration> delays;  // usual ones, from the stamp to the recorder
    for (const Feed& feed : feeds_)
    {
        std::vector<Duration> of_feed;
        for (const Held& held : feed.ahead)
            if (held.stamp) of_feed.push_back(held.received - *held.stamp);
        if (of_feed.size() < kFewest) return;
        delays.push_back(median(std::move(of_feed)));
    }
    if (delays.size() < 2) return;
    const Duration ahead = delays[1] - delays[0] + lidar_clock_offset_;
    if (std::abs(ahead) <= kLargestDelay || !warn_) return;
    const double seconds = toSeconds(std::abs(ahead));
    warn_(
        {0, "clock_offset",
         format(
             "by when the recorder got them, the stamps of the LiDAR are %.1f s %s those of the "
             "IMU%s: a rig file (-r) with lidar: {clock_offset: %.1f} corrects that",
             seconds, ahead > 0 ? "ahead of" : "behind", causeOf(std::abs(ahead)).c_str(),
             toSeconds(lidar_clock_offset_ - ahead))});
}
}  // namespace taut::bag
