#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "taut/core/Time.h"
#include "taut/packets/velodyne/Decoder.h"

namespace taut::velodyne
{
using Packet = std::array<std::uint8_t, kPacketBytes>;

/** What one laser measured; range 0 is no return. */
struct Cell
{
    double range = 0;  //!< [m], kept to 2 mm; farther than 131.07 m is no return
    std::uint8_t intensity = 0;
};

/** Packs the firing sequences of a VLP-16 or HDL-32E into data packets, strongest-return mode: the
 * inverse of decodePacket() up to the packets' resolution (2 mm, 0.01 deg, 1 us). */
class PacketWriter
{
 public:
    explicit PacketWriter(Model model) : model_(model) {}

    /** Adds a firing sequence that begins at `t` (UNIX time; the packet keeps microseconds past the
     * hour) with the head at `azimuth` [deg, clockwise]; one cell a laser. Sequences within a
     * packet must follow each other at the sensor's own period, to 2 us. Throws
     * std::invalid_argument on a wrong number of cells or time. */
    void add(Time t, double azimuth, const std::vector<Cell>& cells);

    /** The packets completed by now, and forgets them. With `flush` the last one is filled up with
     * sequences without returns. */
    std::vector<Packet> take(bool flush = false);

    /** Sequences that one packet holds. */
    int sequencesPerPacket() const { return kBlocks * firingPattern(model_).sequences; }

 private:
    void begin(Time t);

    Model model_;
    std::vector<Packet> complete_;
    Packet current_{};
    int sequences_ = 0;  // in current_
    Time packet_start_ = 0;
    double last_azimuth_ = 0, azimuth_step_ = 0;
};
}  // namespace taut::velodyne
