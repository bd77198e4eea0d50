#pragma once

#include "support.h"
#include "taut/importing/pcap/PacketDecoder.h"

namespace taut::fuzz
{
/** Pieces as datagrams of a sensor; one that is refused is left out, as the readers do. */
inline void decodePackets(Input input, PacketDecoder& decoder, std::uint16_t port)
{
    ImportedItems items;
    Time captured = 1'700'000'000'000'000'000;
    while (!input.empty())
    {
        UdpDatagram datagram;
        datagram.captured = captured += 1'000'000;
        datagram.payload = input.piece().bytes();
        datagram.from_port = datagram.to_port = port;
        if (datagram.payload.size() == 48) datagram.to_port = 7503;  // the IMU in an Ouster
        if (!decoder.recognises(datagram)) continue;
        readOrRefuse([&] { decoder.add(datagram, items); });
    }
    readOrRefuse([&] { decoder.finish(items, [](const Warning&) {}); });
    decoder.findings();
    for (const ImportedItem& item : items)
        if (const auto* scan = std::get_if<Scan>(&item))
            for (const LidarPoint& point : scan->points)
                require(point.position.allFinite(), "points are finite");
}
}  // namespace taut::fuzz
