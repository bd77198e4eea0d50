#include "FragmentBuffer.h"

#include <algorithm>

namespace taut
{
std::optional<std::vector<std::uint8_t>> FragmentBuffer::add(
    const Key& key, std::size_t offset, bool more_follow, const std::uint8_t* bytes,
    std::size_t size)
{
    auto packet = std::find_if(
        pending_.begin(), pending_.end(), [&key](const Packet& p) { return p.key == key; });
    if (packet == pending_.end())
    {
        if (pending_.size() == kMostPending)
        {
            pending_.pop_front();
            given_up_++;
        }
        packet = pending_.insert(pending_.end(), {key, {}, 0});
    }
    packet->pieces[offset].assign(bytes, bytes + size);
    if (!more_follow) packet->total = offset + size;
    auto whole = joined(*packet);
    if (whole) pending_.erase(packet);
    return whole;
}

std::optional<std::vector<std::uint8_t>> FragmentBuffer::joined(const Packet& packet)
{
    if (packet.total == 0) return {};
    std::vector<std::uint8_t> whole;
    whole.reserve(packet.total);
    for (const auto& [offset, piece] : packet.pieces)
    {
        if (offset != whole.size()) return {};
        whole.insert(whole.end(), piece.begin(), piece.end());
    }
    if (whole.size() != packet.total) return {};
    return whole;
}
}  // namespace taut
