#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace taut
{
/** A hash table from keys to numbers. It is small, and tells a processor where it is going to look:
 * who asks for many keys has all their places fetched from memory at once, and does not wait for
 * each in turn. */
class KeyTable
{
 public:
    static constexpr std::uint32_t kNone = 0xffffffff;

    /** Has the place of a key at hand when it is needed soon. */
    void prefetch(std::uint64_t key) const { __builtin_prefetch(&places_[placeOf(key)]); }

    /** The number of a key, or kNone. */
    std::uint32_t find(std::uint64_t key) const { return places_[search(key)].number; }

    /** Any number but kNone for a key that is not in the table. */
    void insert(std::uint64_t key, std::uint32_t number)
    {
        if (2 * (size_ + 1) > places_.size()) grow();
        places_[search(key)] = {key, number};
        size_++;
    }

    /** Erases each key for which `leaves(key, number)` is true. Calls it once for every key. */
    template <class Leaves>
    void eraseIf(const Leaves& leaves)
    {
        std::vector<Place> old(places_.size());
        old.swap(places_);
        size_ = 0;
        for (const Place& p : old)
            if (p.number != kNone && !leaves(p.key, p.number)) insert(p.key, p.number);
    }

    /** Calls `visit(key, number)` for every key. */
    template <class Visit>
    void forEach(const Visit& visit) const
    {
        for (const Place& p : places_)
            if (p.number != kNone) visit(p.key, p.number);
    }

    /** Forgets all, and keeps the memory. */
    void clear()
    {
        if (size_ > 0) std::fill(places_.begin(), places_.end(), Place{});
        size_ = 0;
    }

    std::size_t size() const { return size_; }

 private:
    struct Place
    {
        std::uint64_t key = 0;
        std::uint32_t number = kNone;
    };

    /** Mixes all bits of a key into the low ones, which alone choose the place. */
    std::size_t placeOf(std::uint64_t key) const
    {
        key *= 0x9e3779b97f4a7c15ULL;
        return (key ^ (key >> 32)) & (places_.size() - 1);
    }

    /** The place of the key, or the free one where it belongs. */
    std::size_t search(std::uint64_t key) const
    {
        std::size_t at = placeOf(key);
        while (places_[at].number != kNone && places_[at].key != key)
            at = (at + 1) & (places_.size() - 1);
        return at;
    }

    void grow()
    {
        std::vector<Place> old(2 * places_.size());
        old.swap(places_);
        for (const Place& p : old)
            if (p.number != kNone) places_[search(p.key)] = p;
    }

    std::vector<Place> places_{std::vector<Place>(64)};  // a power of two, at most half of it taken
    std::size_t size_ = 0;
};
}  // namespace taut
