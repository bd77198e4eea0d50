#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/Time.h"

namespace taut
{
/** What a sensor sent in one piece. */
struct UdpDatagram
{
    Time captured = 0;       //!< by the clock of the capturing computer
    std::uint32_t from = 0;  //!< IPv4 address of the sender, 192.0.2.1 = 0xc0000201
    std::uint16_t from_port = 0, to_port = 0;
    std::vector<std::uint8_t> payload;
};

/** "192.0.2.1" */
std::string addressText(std::uint32_t address);

/** The UDP datagrams (IPv4) of a packet capture: pcap or pcapng, Ethernet with or without VLANs,
 * Linux "any", loopback or raw IP. Datagrams that travelled in fragments are put together. */
class PcapReader
{
 public:
    /** Throws std::runtime_error naming the file and the cause. */
    explicit PcapReader(const std::string& path);
    ~PcapReader();

    /** The next datagram; nothing at the end, or where the file cannot be read on. */
    std::optional<UdpDatagram> next();

    /** Share of the file that was read, 0 to 1. */
    double progress() const;

    /** Why the reading stopped before the end of the capture; empty if it did not. */
    const std::string& damage() const;

    struct Counts
    {
        std::size_t records = 0;     //!< read
        std::size_t datagrams = 0;   //!< given out
        std::size_t cut = 0;         //!< records that the capture does not hold in whole
        std::size_t unfinished = 0;  //!< datagrams whose fragments are not all there
    };
    /** As of now; unfinished datagrams that may still be completed count from the end on. */
    const Counts& counts() const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace taut
