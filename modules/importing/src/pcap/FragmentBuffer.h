#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

namespace taut
{
/** Puts IPv4 packets together that travelled in fragments (RFC 791). Memory is bounded: of more
 * than kMostPending unfinished packets the oldest is given up. */
class FragmentBuffer
{
 public:
    static constexpr std::size_t kMostPending = 64;

    struct Key
    {
        std::uint32_t from = 0, to = 0;
        std::uint16_t id = 0;

        bool operator==(const Key& o) const
        {
            return std::tie(from, to, id) == std::tie(o.from, o.to, o.id);
        }
    };

    /** Adds `size` bytes that belong at `offset`; gives the whole where this was the last piece
     * that was missing. */
    std::optional<std::vector<std::uint8_t>> add(
        const Key& key, std::size_t offset, bool more_follow, const std::uint8_t* bytes,
        std::size_t size);

    /** Packets that were given up, and those still waiting for a piece. */
    std::size_t unfinished() const { return given_up_ + pending_.size(); }

 private:
    struct Packet
    {
        Key key;
        std::map<std::size_t, std::vector<std::uint8_t>> pieces;  // by offset
        std::size_t total = 0;                                    // 0: not known yet
    };

    static std::optional<std::vector<std::uint8_t>> joined(const Packet& packet);

    std::list<Packet> pending_;  // the oldest first
    std::size_t given_up_ = 0;
};
}  // namespace taut
