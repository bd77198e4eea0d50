#include "taut/importing/pcap/PcapReader.h"

#include <pcap/pcap.h>

#include <array>
#include <filesystem>
#include <stdexcept>

#include "FragmentBuffer.h"

namespace taut
{
namespace
{
constexpr std::uint16_t kIpv4 = 0x0800, kVlan = 0x8100, kServiceVlan = 0x88a8;
constexpr std::uint8_t kUdp = 17;
constexpr std::size_t kUdpHeader = 8, kIpHeader = 20;

/** Bytes of a record, in the order of the network. */
struct Bytes
{
    const std::uint8_t* data;
    std::size_t size;

    std::uint16_t u16(std::size_t at) const
    {
        return static_cast<std::uint16_t>(data[at] << 8 | data[at + 1]);
    }
    std::uint32_t u32(std::size_t at) const
    {
        return static_cast<std::uint32_t>(u16(at)) << 16 | u16(at + 2);
    }
    Bytes from(std::size_t at) const { return {data + at, size - at}; }
};

/** The IPv4 packet in an Ethernet frame whose type stands at `type_at`. */
std::optional<Bytes> afterType(Bytes record, std::size_t type_at)
{
    for (; record.size >= type_at + 2; type_at += 4)
    {
        const std::uint16_t type = record.u16(type_at);
        if (type == kIpv4) return record.from(type_at + 2);
        if (type != kVlan && type != kServiceVlan) return {};
    }
    return {};
}

/** The IPv4 packet in a record of that link layer (pcap-linktype(7)). */
std::optional<Bytes> ipPacket(int link, Bytes record)
{
    constexpr std::size_t kSll2Header = 20, kNullHeader = 4;
    switch (link)
    {
        case DLT_EN10MB:
            return afterType(record, 12);
        case DLT_LINUX_SLL:
            return afterType(record, 14);
        case DLT_LINUX_SLL2:
            if (record.size < kSll2Header || record.u16(0) != kIpv4) return {};
            return record.from(kSll2Header);
        case DLT_NULL:
        case DLT_LOOP:
            if (record.size < kNullHeader) return {};
            return record.from(kNullHeader);
        default:  // DLT_RAW, DLT_IPV4
            return record;
    }
}

bool isKnownLink(int link)
{
    for (const int known :
         {DLT_EN10MB, DLT_LINUX_SLL, DLT_LINUX_SLL2, DLT_NULL, DLT_LOOP, DLT_RAW, DLT_IPV4})
        if (link == known) return true;
    return false;
}
}  // namespace

std::string addressText(std::uint32_t a)
{
    return std::to_string(a >> 24) + "." + std::to_string(a >> 16 & 255) + "." +
           std::to_string(a >> 8 & 255) + "." + std::to_string(a & 255);
}

struct PcapReader::Impl
{
    explicit Impl(const std::string& path) : bytes(std::filesystem::file_size(path))
    {
        std::array<char, PCAP_ERRBUF_SIZE> error{};
        pcap.reset(pcap_open_offline_with_tstamp_precision(
            path.c_str(), PCAP_TSTAMP_PRECISION_NANO, error.data()));
        if (!pcap)
            throw std::runtime_error("cannot read the capture '" + path + "': " + error.data());
        link = pcap_datalink(pcap.get());
        if (isKnownLink(link)) return;
        const char* name = pcap_datalink_val_to_description_or_dlt(link);
        throw std::runtime_error(
            "'" + path + "' was captured from a link that is not known here: " + name);
    }

    std::optional<UdpDatagram> datagram(Bytes ip);
    static bool readUdp(Bytes udp, UdpDatagram& datagram);

    struct Closer
    {
        void operator()(pcap_t* p) const { pcap_close(p); }
    };
    std::unique_ptr<pcap_t, Closer> pcap;
    int link = 0;
    std::uintmax_t bytes;
    FragmentBuffer fragments;
    Counts counts;
    std::string damage;
};

/** Nothing where this is no UDP, or not the last missing fragment of it. */
std::optional<UdpDatagram> PcapReader::Impl::datagram(Bytes ip)
{
    if (ip.size < kIpHeader || ip.data[0] >> 4 != 4 || ip.data[9] != kUdp) return {};
    const std::size_t header = (ip.data[0] & 15u) * 4u, total = ip.u16(2);
    if (header < kIpHeader || total < header || ip.size < total) return {};
    const Bytes body{ip.data + header, total - header};
    UdpDatagram datagram;
    datagram.from = ip.u32(12);
    const std::uint16_t fragment = ip.u16(6);
    const bool more_follow = (fragment & 0x2000) != 0;
    const std::size_t offset = (fragment & 0x1fffu) * 8u;
    if (offset == 0 && !more_follow)
    {
        if (!readUdp(body, datagram)) return {};
        return datagram;
    }
    const auto whole = fragments.add(
        {datagram.from, ip.u32(16), ip.u16(4)}, offset, more_follow, body.data, body.size);
    if (!whole || !readUdp({whole->data(), whole->size()}, datagram)) return {};
    return datagram;
}

bool PcapReader::Impl::readUdp(Bytes udp, UdpDatagram& datagram)
{
    if (udp.size < kUdpHeader) return false;
    const std::size_t length = udp.u16(4);
    if (length < kUdpHeader || length > udp.size) return false;
    datagram.from_port = udp.u16(0);
    datagram.to_port = udp.u16(2);
    datagram.payload.assign(udp.data + kUdpHeader, udp.data + length);
    return true;
}

PcapReader::PcapReader(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
PcapReader::~PcapReader() = default;

std::optional<UdpDatagram> PcapReader::next()
{
    pcap_pkthdr* header = nullptr;
    const u_char* data = nullptr;
    while (impl_->damage.empty())
    {
        const int result = pcap_next_ex(impl_->pcap.get(), &header, &data);
        if (result == PCAP_ERROR) impl_->damage = pcap_geterr(impl_->pcap.get());
        if (result != 1) break;
        impl_->counts.records++;
        if (header->caplen < header->len) impl_->counts.cut++;
        const auto ip = ipPacket(impl_->link, {data, header->caplen});
        auto datagram = ip ? impl_->datagram(*ip) : std::nullopt;
        if (!datagram) continue;
        // With nanosecond precision asked for, tv_usec holds nanoseconds.
        datagram->captured =
            static_cast<Time>(header->ts.tv_sec) * 1'000'000'000 + header->ts.tv_usec;
        impl_->counts.datagrams++;
        return datagram;
    }
    impl_->counts.unfinished = impl_->fragments.unfinished();
    return {};
}

double PcapReader::progress() const
{
    const auto position = std::ftell(pcap_file(impl_->pcap.get()));
    return position < 0 ? 1 : static_cast<double>(position) / static_cast<double>(impl_->bytes);
}

const std::string& PcapReader::damage() const
{
    return impl_->damage;
}

const PcapReader::Counts& PcapReader::counts() const
{
    return impl_->counts;
}
}  // namespace taut
