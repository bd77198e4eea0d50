#include "taut/packets/velodyne/PacketWriter.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "PacketLayout.h"

namespace taut::velodyne
{
namespace
{
constexpr double kTimeTolerance = 2000;  // [ns]

std::uint16_t azimuthUnits(double degrees)
{
    const long units = std::lround(degrees / kAzimuthUnit) % kFullTurn;
    return static_cast<std::uint16_t>(units < 0 ? units + kFullTurn : units);
}

std::uint16_t rangeUnits(double range)
{
    const double units = std::round(range / kRangeUnit);
    return units >= 0 && units <= 65535 ? static_cast<std::uint16_t>(units) : 0;
}
}  // namespace

void PacketWriter::begin(Time t)
{
    current_.fill(0);
    packet_start_ = t;
    const std::int64_t past_hour = ((t + 500) / 1000) % kHour;
    write32(current_.data() + kTimeAt, static_cast<std::uint32_t>(past_hour));
    current_[kModeAt] = static_cast<std::uint8_t>(ReturnMode::Strongest);
    current_[kModelAt] = static_cast<std::uint8_t>(model_);
}

void PacketWriter::add(Time t, double azimuth, const std::vector<Cell>& cells)
{
    const FiringPattern& pattern = firingPattern(model_);
    if (cells.size() != static_cast<std::size_t>(pattern.lasers))
        throw std::invalid_argument(
            "a firing sequence needs " + std::to_string(pattern.lasers) + " cells, not " +
            std::to_string(cells.size()));
    if (sequences_ == 0) begin(t);
    const double due = sequences_ * pattern.sequence_period;
    if (std::abs(static_cast<double>(t - packet_start_) - due) > kTimeTolerance)
        throw std::invalid_argument(
            "firing sequence " + std::to_string(sequences_) + " of a packet comes " +
            std::to_string(t - packet_start_) + " ns after the first one instead of " +
            std::to_string(due));
    const int block = sequences_ / pattern.sequences;
    const int first_slot = sequences_ % pattern.sequences * pattern.lasers;
    if (first_slot == 0)
    {
        write16(current_.data() + blockAt(block), kBlockFlag);
        write16(current_.data() + blockAt(block) + 2, azimuthUnits(azimuth));
    }
    for (int laser = 0; laser < pattern.lasers; laser++)
    {
        auto* out = current_.data() + returnAt(block, first_slot + laser);
        write16(out, rangeUnits(cells[laser].range));
        out[2] = cells[laser].intensity;
    }
    azimuth_step_ = std::fmod(azimuth - last_azimuth_ + 720, 360);
    last_azimuth_ = azimuth;
    if (++sequences_ < sequencesPerPacket()) return;
    complete_.push_back(current_);
    sequences_ = 0;
}

std::vector<Packet> PacketWriter::take(bool flush)
{
    const FiringPattern& pattern = firingPattern(model_);
    while (flush && sequences_ > 0)
        add(packet_start_ + std::llround(sequences_ * pattern.sequence_period),
            last_azimuth_ + azimuth_step_,
            std::vector<Cell>(static_cast<std::size_t>(pattern.lasers)));
    return std::exchange(complete_, {});
}
}  // namespace taut::velodyne
