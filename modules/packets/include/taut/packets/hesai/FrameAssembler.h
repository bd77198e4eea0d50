#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "taut/packets/TurnAssembler.h"
#include "taut/packets/hesai/Decoder.h"

namespace taut::hesai
{
/** Puts the returns of data packets together to scans of one turn, in the frame of Return. */
class FrameAssembler
{
 public:
    /** Throws CorrectionError if the calibration is not that of such a sensor. */
    FrameAssembler(Model model, Calibration calibration);

    /** A packet in the order of arrival. Appends the turns that it shows to be complete, by the
     * sensor's clock. Throws std::runtime_error, and forgets the packet, if it is of another model
     * or as decodePacket(). */
    void add(const std::uint8_t* packet, std::size_t bytes, std::vector<Scan>& complete);

    /** Appends what is left at the end. */
    void finish(std::vector<Scan>& complete) { turns_.finish(complete); }

    /** When the last laser of the packet added last fired. */
    Time packetEnd() const { return packet_end_; }

 private:
    Model model_;
    Calibration calibration_;
    TurnAssembler turns_;
    std::vector<Return> returns_;  // of a packet
    Time packet_end_ = 0;
};
}  // namespace taut::hesai
