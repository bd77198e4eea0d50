#include "taut/packets/velodyne/FrameAssembler.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "PacketLayout.h"

namespace taut::velodyne
{
namespace
{
constexpr Duration kLatest = 50'000'000;  // a packet that is no sign of a clock set back
}

FrameAssembler::FrameAssembler(Model model, Calibration calibration)
    : model_(model), calibration_(std::move(calibration)), turns_(firingPattern(model).lasers)
{
}

void FrameAssembler::add(const std::uint8_t* packet, std::vector<Scan>& complete)
{
    if (packetInfo(packet).model != model_)
        throw std::runtime_error("a packet is of another model of Velodyne");
    PacketClock clock = clock_;
    const Duration t = clock.sinceFirst(packetInfo(packet).microseconds);
    const int azimuth = blockAzimuth(packet, 0);
    returns_.clear();
    const bool late = last_azimuth_ >= 0 && t < last_;  // the head turns as before
    const double rate = late ? rate_ : turningRate(azimuth, t);
    const PacketInfo info = decodePacket(packet, calibration_, returns_, rate);
    clock_ = clock;
    rate_ = rate;
    packet_end_ = t;
    auto next = returns_.begin();
    for (int block = 0; block < usedBlocks(info); block++)
    {
        // The time of an empty block hardly matters: that of the one before it will do.
        const bool empty = next == returns_.end() || next->block != block;
        packet_end_ = empty ? packet_end_ : t + next->offset;
        turns_.beginBlock(blockAzimuth(packet, block) % kFullTurn, packet_end_, complete);
        for (; next != returns_.end() && next->block == block; ++next)
            turns_.add(next->position, next->intensity, next->laser, t + next->offset);
    }
    if (!late || last_ - t > kLatest)
    {
        last_azimuth_ = azimuth;
        last_ = t;
    }
    packet_end_ += std::llround(firingPattern(model_).blockPeriod());
}

double FrameAssembler::turningRate(int azimuth, Duration t) const
{
    if (last_azimuth_ < 0 || t <= last_) return 0;
    const int turned = (azimuth - last_azimuth_ + kFullTurn) % kFullTurn;
    return turned * kAzimuthUnit / static_cast<double>(t - last_);
}
}  // namespace taut::velodyne
