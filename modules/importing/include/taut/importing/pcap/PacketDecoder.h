#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "taut/core/Warning.h"
#include "taut/importing/ImportSource.h"
#include "taut/importing/pcap/PcapReader.h"
#include "taut/packets/ouster/SensorInfo.h"

namespace taut
{
using ImportedItems = std::deque<ImportedItem>;

/** Whose clock the stamps are of. */
enum class StampClock
{
    Sensor,
    Capture,       //!< of the computer that took the packets
    SensorIfClose  //!< the sensor's if it is within half a second of the computer's
};

/** What one make of sensor sends, to what it measured. */
class PacketDecoder
{
 public:
    PacketDecoder() = default;
    virtual ~PacketDecoder() = default;
    PacketDecoder(const PacketDecoder&) = delete;
    PacketDecoder& operator=(const PacketDecoder&) = delete;

    virtual std::string make() const = 0;

    /** True if the datagram looks like one of this make. */
    virtual bool recognises(const UdpDatagram& datagram) const = 0;

    /** False for a datagram that it recognises by its port, but that has not the size of a packet.
     */
    virtual bool isOfItsKind(const UdpDatagram&) const { return true; }

    /** Why a datagram that it recognises is not of its sensor; empty if it may be. */
    virtual std::string misfit(const UdpDatagram&) const { return {}; }

    /** Throws std::runtime_error if the datagram cannot be used; ouster::DescriptionError and
     * hesai::CorrectionError if none can be. */
    virtual void add(const UdpDatagram& datagram, ImportedItems& items) = 0;

    /** What is left at the end. */
    virtual void finish(ImportedItems& items, const WarningSink& warn) = 0;

    /** As ImportSource::findings(). */
    virtual std::vector<std::string> findings() const = 0;
};

/** With `keep_packets` the sweeps of a VLP-16 and an HDL-32E are given as packets, which other
 * readers of rawlogs know; a sweep begins with a whole packet then. */
std::unique_ptr<PacketDecoder> makeVelodyneDecoder(StampClock clock, bool keep_packets);
std::unique_ptr<PacketDecoder> makeOusterDecoder(const ouster::SensorInfo& info, StampClock clock);

/** Angles of the lasers are those of the file `correction`; if that is empty, of one beside the
 * recording; else the data sheet's. Both may be empty. */
std::unique_ptr<PacketDecoder> makeHesaiDecoder(
    const std::string& recording, const std::string& correction, StampClock clock);
}  // namespace taut
