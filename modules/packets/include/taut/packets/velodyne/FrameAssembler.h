#pragma once

#include <vector>

#include "taut/packets/TurnAssembler.h"
#include "taut/packets/velodyne/Decoder.h"

namespace taut::velodyne
{
/** Puts the returns of data packets together to scans of one turn, in the frame of Return. */
class FrameAssembler
{
 public:
    FrameAssembler(Model model, Calibration calibration);

    /** A packet of kPacketBytes in the order of arrival. Appends the turns that it shows to be
     * complete; their times count from the stamp of the first packet of all. Throws
     * std::runtime_error, and forgets the packet, if it is of another model or as decodePacket().
     */
    void add(const std::uint8_t* packet, std::vector<Scan>& complete);

    /** Appends what is left at the end. */
    void finish(std::vector<Scan>& complete) { turns_.finish(complete); }

    /** When the firings of the packet added last were over, since the first packet of all. */
    Duration packetEnd() const { return packet_end_; }

 private:
    double turningRate(int azimuth, Duration t) const;

    Model model_;
    Calibration calibration_;
    PacketClock clock_;
    TurnAssembler turns_;
    std::vector<Return> returns_;  // of a packet
    int last_azimuth_ = -1;
    double rate_ = 0;  // as turningRate() had it last
    Duration last_ = 0, packet_end_ = 0;
};
}  // namespace taut::velodyne
