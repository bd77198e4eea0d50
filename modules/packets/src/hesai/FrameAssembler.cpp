#include "taut/packets/hesai/FrameAssembler.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace taut::hesai
{
namespace
{
constexpr int kFullTurn = 36000;  // [0.01 deg]
}

FrameAssembler::FrameAssembler(Model model, Calibration calibration)
    : model_(model), calibration_(std::move(calibration)), turns_(lasersOf(model))
{
    checkCorrection(calibration_, model);
}

void FrameAssembler::add(const std::uint8_t* packet, std::size_t bytes, std::vector<Scan>& complete)
{
    if (const Model model = packetInfo(packet, bytes).model; model != model_)
        throw std::runtime_error(
            "a packet is of a " + nameOf(model) + " after those of a " + nameOf(model_));
    returns_.clear();
    const PacketInfo info = decodePacket(packet, bytes, calibration_, returns_);
    packet_end_ = info.t + static_cast<Duration>(firingTime(info, 0, 0));
    auto next = returns_.begin();
    for (int block = 0; block < blocksOf(model_); block++)
    {
        const Time t = info.t + static_cast<Duration>(firingTime(info, block, 0));
        turns_.beginBlock(blockAzimuth(packet, model_, block) % kFullTurn, t, complete);
        packet_end_ = std::max(packet_end_, t);
        for (; next != returns_.end() && next->block == block; ++next)
        {
            const Time fired = info.t + next->offset;
            turns_.add(next->position, next->reflectivity, next->laser, fired);
            packet_end_ = std::max(packet_end_, fired);
        }
    }
}
}  // namespace taut::hesai
