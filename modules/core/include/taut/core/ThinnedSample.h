#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace taut
{
/** An even sample of a sequence of unknown length: every item at first, every second one once
 * `capacity` is reached, every fourth after that... Holds between half of the capacity and all. */
template <class Item>
class ThinnedSample
{
 public:
    explicit ThinnedSample(std::size_t capacity) : capacity_(capacity) {}

    void add(const Item& item)
    {
        if (seen_++ % stride_ != 0) return;
        items_.push_back(item);
        if (items_.size() < capacity_) return;
        for (std::size_t i = 0; 2 * i < items_.size(); i++) items_[i] = items_[2 * i];
        items_.resize((items_.size() + 1) / 2);
        stride_ *= 2;
    }

    /** Drops the items that a predicate tells. */
    template <class Predicate>
    void removeIf(const Predicate& predicate)
    {
        items_.erase(std::remove_if(items_.begin(), items_.end(), predicate), items_.end());
    }

    const std::vector<Item>& items() const { return items_; }

 private:
    std::size_t capacity_, seen_ = 0, stride_ = 1;
    std::vector<Item> items_;
};
}  // namespace taut
