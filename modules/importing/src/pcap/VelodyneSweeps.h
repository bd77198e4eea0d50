#pragma once

#include <optional>

#include "taut/rawlog/RawlogWriter.h"

namespace taut
{
/** A sweep of packets as it came. */
struct VelodyneSweep
{
    PacketScan scan;    //!< stamp by the sensor: time since the first packet of all [ns]
    Time captured = 0;  //!< of its first firing, had its first packet been captured without delay
};

/** Cuts the packets of a VLP-16 or HDL-32E into sweeps where the azimuth passes zero: the packet in
 * which that happens is the last one of its sweep, so that no packet is changed or doubled. */
class VelodyneSweeps
{
 public:
    /** A packet in the order of arrival. Gives the sweep that this packet shows to be complete.
     * Throws std::runtime_error, and forgets the packet, if it is none of a known model. */
    std::optional<VelodyneSweep> add(const velodyne::Packet& packet, Time captured);

    /** What is left at the end. */
    std::optional<VelodyneSweep> finish();

    /** Packets that are missing, by the sensor's clock; those of a sector that it does not fire in
     * look the same. */
    std::size_t missing() const { return missing_; }

 private:
    VelodyneSweep sweep_;
    velodyne::PacketClock clock_;
    Duration last_ = 0;  // of the packet before
    int last_azimuth_ = -1;
    std::size_t missing_ = 0;
};
}  // namespace taut
