#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace taut
{
/** Tells packets that were captured twice, a few packets apart, as where two interfaces were
 * captured at once. */
class Repetition
{
 public:
    /** True if the same bytes came a few packets before. */
    bool is(const std::vector<std::uint8_t>& payload)
    {
        if (std::find(recent_.begin(), recent_.end(), payload) != recent_.end())
        {
            count_++;
            return true;
        }
        if (recent_.size() == kRemembered) recent_.pop_front();
        recent_.push_back(payload);
        return false;
    }

    void report(std::vector<std::string>& lines) const
    {
        if (count_ > 0)
            lines.push_back(std::to_string(count_) + " packets came twice and were taken once");
    }

 private:
    static constexpr std::size_t kRemembered = 8;

    std::deque<std::vector<std::uint8_t>> recent_;
    std::size_t count_ = 0;
};
}  // namespace taut
