#pragma once

#include <pcap/pcap.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "taut/core/Time.h"

namespace taut::test
{
/** Writes UDP datagrams to a packet capture, as they would travel over Ethernet. */
class PcapWriter
{
 public:
    explicit PcapWriter(const std::string& path, int link = DLT_EN10MB)
        : pcap_(pcap_open_dead(link, 65535)), dumper_(pcap_dump_open(pcap_.get(), path.c_str()))
    {
    }

    std::uint32_t from = 0xc0a801c9;  //!< 192.168.1.201
    std::size_t mtu = 1500;           //!< larger IP packets travel in fragments
    bool last_fragment_first = false, lose_fragment = false;
    int vlan_tags = 0;
    unsigned snap_length = 65535;

    template <class Bytes>
    void write(Time t, std::uint16_t port, const Bytes& payload)
    {
        std::vector<std::uint8_t> udp;
        put16(udp, port);
        put16(udp, port);
        put16(udp, static_cast<std::uint16_t>(8 + payload.size()));
        put16(udp, 0);
        udp.insert(udp.end(), payload.begin(), payload.end());
        id_++;
        const std::size_t piece = (mtu - 20) / 8 * 8;
        std::vector<std::size_t> offsets;
        for (std::size_t at = 0; at < udp.size(); at += piece) offsets.push_back(at);
        if (lose_fragment && offsets.size() > 1) offsets.erase(offsets.begin() + 1);
        if (last_fragment_first) std::reverse(offsets.begin(), offsets.end());
        for (const std::size_t at : offsets) writeFragment(t, udp, at, piece);
    }

 private:
    static void put16(std::vector<std::uint8_t>& to, unsigned value)
    {
        to.push_back(static_cast<std::uint8_t>(value >> 8 & 255));
        to.push_back(static_cast<std::uint8_t>(value & 255));
    }

    /** What stands before the IP packet. */
    std::vector<std::uint8_t> linkHeader() const
    {
        const int link = pcap_datalink(pcap_.get());
        if (link == DLT_RAW) return {};
        if (link == DLT_NULL) return {2, 0, 0, 0};
        if (link == DLT_LINUX_SLL2)
        {
            std::vector<std::uint8_t> header{8, 0};
            header.resize(20);
            return header;
        }
        std::vector<std::uint8_t> header(link == DLT_LINUX_SLL ? 14 : 12, 2);
        for (int i = 0; i < vlan_tags; i++)
        {
            put16(header, 0x8100);
            put16(header, 7);
        }
        put16(header, 0x0800);
        return header;
    }

    void writeFragment(
        Time t, const std::vector<std::uint8_t>& udp, std::size_t at, std::size_t piece)
    {
        const std::size_t size = std::min(piece, udp.size() - at);
        std::vector<std::uint8_t> frame = linkHeader();
        put16(frame, 0x4500);
        put16(frame, static_cast<unsigned>(20 + size));
        put16(frame, id_);
        put16(frame, static_cast<unsigned>((at + size < udp.size() ? 0x2000 : 0) | at / 8));
        put16(frame, 64 << 8 | 17);
        put16(frame, 0);
        put16(frame, from >> 16);
        put16(frame, from & 0xffff);
        put16(frame, 0xffff);
        put16(frame, 0xffff);
        const auto begin = udp.begin() + static_cast<std::ptrdiff_t>(at);
        frame.insert(frame.end(), begin, begin + static_cast<std::ptrdiff_t>(size));
        pcap_pkthdr header{};
        header.ts.tv_sec = t / 1'000'000'000;
        header.ts.tv_usec = t % 1'000'000'000 / 1000;
        header.len = static_cast<bpf_u_int32>(frame.size());
        header.caplen = std::min(header.len, snap_length);
        pcap_dump(reinterpret_cast<u_char*>(dumper_.get()), &header, frame.data());
    }

    struct Closer
    {
        void operator()(pcap_t* p) const { pcap_close(p); }
        void operator()(pcap_dumper_t* d) const { pcap_dump_close(d); }
    };
    std::unique_ptr<pcap_t, Closer> pcap_;
    std::unique_ptr<pcap_dumper_t, Closer> dumper_;
    unsigned id_ = 0;
};
}  // namespace taut::test
