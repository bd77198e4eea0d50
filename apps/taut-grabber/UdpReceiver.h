#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "taut/importing/pcap/PcapReader.h"

namespace taut
{
/** Datagrams as they arrive at ports of this computer, stamped when its kernel got them. */
class UdpReceiver
{
 public:
    /** `address` is this computer's (IPv4) that is listened at, 0.0.0.0 for all. Throws
     * std::runtime_error naming the port if one cannot be had. */
    UdpReceiver(const std::string& address, const std::vector<std::uint16_t>& ports);
    ~UdpReceiver();
    UdpReceiver(const UdpReceiver&) = delete;
    UdpReceiver& operator=(const UdpReceiver&) = delete;

    /** The next datagram; nothing if none comes for so long. Throws std::runtime_error if the
     * network fails. */
    std::optional<UdpDatagram> next(std::chrono::milliseconds wait);

    /** Datagrams that the kernel had no room for. */
    std::size_t lost() const;

 private:
    struct Socket
    {
        int file = -1;
        std::uint16_t port = 0;
        std::uint32_t lost = 0;
    };

    void open(std::uint32_t address, std::uint16_t port);
    void close();
    std::optional<UdpDatagram> receive(Socket& socket);

    std::vector<Socket> sockets_;
    std::vector<std::uint8_t> buffer_;
};
}  // namespace taut
