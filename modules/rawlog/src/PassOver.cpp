#include "PassOver.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "MrptConversion.h"

namespace taut
{
namespace
{
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kKept = 1024;  // at each end of the object, to look for a label in
constexpr std::size_t kLongestLabel = 200;
constexpr std::int64_t kTicksASecond = 10'000'000, kYear = 31'557'600 * kTicksASecond;

/** The first and the last bytes of what goes by. */
class Ends
{
 public:
    void add(const std::uint8_t* data, std::size_t size)
    {
        head_.insert(head_.end(), data, data + std::min(size, kKept - head_.size()));
        const std::size_t n = std::min(size, kKept);
        tail_.insert(tail_.end(), data + (size - n), data + size);
        if (tail_.size() > kKept)
            tail_.erase(tail_.begin(), tail_.end() - static_cast<std::ptrdiff_t>(kKept));
    }
    const Bytes& head() const { return head_; }
    const Bytes& tail() const { return tail_; }

 private:
    Bytes head_, tail_;
};

/* A stamp between 1980 and 2120, in MRPT's ticks. */
bool isStamp(const Bytes& bytes, std::size_t at)
{
    if (at > bytes.size() || bytes.size() - at < sizeof(std::int64_t)) return false;
    std::int64_t ticks;
    std::memcpy(&ticks, bytes.data() + at, sizeof ticks);
    return ticks > kTicksTo1970 + 10 * kYear && ticks < kTicksTo1970 + 150 * kYear;
}

/* A number or another stamp may lie between. */
bool isNearStamp(const Bytes& bytes, std::size_t begin, std::size_t end)
{
    constexpr std::size_t kStamp = 8;
    for (const std::size_t i : {0, 4, 8})
        if ((begin >= kStamp + i && isStamp(bytes, begin - kStamp - i)) || isStamp(bytes, end + i))
            return true;
    return false;
}

bool isText(const std::uint8_t* from, const std::uint8_t* to)
{
    return std::all_of(from, to, [](std::uint8_t c) { return c >= ' ' && c != 0x7f; });
}

/* The longest: numbers can look like a letter of length one. */
std::string findLabel(const Bytes& bytes, bool at_end)
{
    std::string label;
    std::uint32_t length = 0;
    for (std::size_t i = 0; i + sizeof length < bytes.size(); i++)
    {
        std::memcpy(&length, bytes.data() + i, sizeof length);
        const std::size_t begin = i + sizeof length, end = begin + length;
        if (length <= label.size() || length > kLongestLabel || end > bytes.size()) continue;
        const bool in_place = isNearStamp(bytes, i, end) || (at_end && end == bytes.size());
        if (in_place && isText(bytes.data() + begin, bytes.data() + end))
            label.assign(bytes.data() + begin, bytes.data() + end);
    }
    return label;
}

/* The place of the object's end mark among the bytes that come next, or `next.size`. */
std::size_t findEnd(const GzInput::Bytes& next, std::size_t marks)
{
    for (std::size_t i = 0; i < next.size; i++)
    {
        const void* found = std::memchr(next.data + i, kObjectEnd, next.size - i);
        if (!found) return next.size;
        i = static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - next.data);
        const std::size_t after = i + marks;
        if (after > next.size || next.data[after - 1] != kObjectEnd) continue;
        if (after == next.size)
        {
            if (next.file_ends) return i;
            continue;
        }
        const auto header = parseObjectHeader(next.data + after, next.size - after);
        if (header && isOfRawlogs(*header)) return i;
    }
    return next.size;
}
}  // namespace

std::string passOver(GzInput& input, const ObjectHeader& header, bool ends_with_frame)
{
    constexpr std::size_t kOverlap = 2 + kLongestHeader;  // a header must be seen whole
    const std::size_t marks = ends_with_frame ? 2 : 1;
    input.skip(header.bytes);
    Ends ends;
    // No more at first than is needed: of a log that is being written it has to be waited for.
    for (std::size_t window = kOverlap;;)
    {
        const auto next = input.peek(window);
        const std::size_t at = findEnd(next, marks);
        const bool found = at < next.size;
        const bool more = next.size >= window;
        if (!found && more && window < GzInput::kPeekSize)
        {
            window = std::min(2 * window, GzInput::kPeekSize);
            continue;
        }
        const std::size_t n = found || !more ? at : next.size - kOverlap;
        ends.add(next.data, n);
        input.skip(found || !more ? n + 1 : n);  // throws where nothing is left
        if (!found) continue;
        const std::string label = findLabel(ends.tail(), true);
        return label.empty() ? findLabel(ends.head(), false) : label;
    }
}
}  // namespace taut
