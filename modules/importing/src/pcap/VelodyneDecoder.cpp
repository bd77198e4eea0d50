#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "VelodyneSweeps.h"
#include "taut/importing/pcap/PacketDecoder.h"

namespace taut
{
namespace
{
constexpr Duration kHour = 3'600'000'000'000;
constexpr Duration kClose = 500'000'000;

/** The time with these microseconds past the hour that is closest to `near`. */
Time inHourClosestTo(Time near, std::uint32_t microseconds)
{
    const Time t = near / kHour * kHour + static_cast<Time>(microseconds) * 1000;
    if (t - near > kHour / 2) return t - kHour;
    return near - t > kHour / 2 ? t + kHour : t;
}

std::string nameOf(const velodyne::PacketInfo& info)
{
    const std::string model = info.model == velodyne::Model::Vlp16 ? "VLP-16" : "HDL-32E";
    switch (info.mode)
    {
        case velodyne::ReturnMode::Strongest:
            return model + ", strongest return";
        case velodyne::ReturnMode::Last:
            return model + ", last return";
        case velodyne::ReturnMode::Dual:
            break;
    }
    return model + ", dual return";
}

class VelodyneDecoder : public PacketDecoder
{
 public:
    explicit VelodyneDecoder(StampClock clock) : clock_(clock) {}

    std::string make() const override { return "Velodyne"; }

    bool recognises(const UdpDatagram& datagram) const override
    {
        const auto& bytes = datagram.payload;
        return bytes.size() == velodyne::kPacketBytes && bytes[0] == 0xff && bytes[1] == 0xee;
    }

    void add(const UdpDatagram& datagram, ImportedItems& items) override
    {
        velodyne::Packet packet;
        std::copy(datagram.payload.begin(), datagram.payload.end(), packet.begin());
        auto sweep = sweeps_.add(packet, datagram.captured);
        if (sweep) items.emplace_back(stamped(std::move(*sweep)));
        if (packets_++ > 0) return;
        info_ = velodyne::packetInfo(packet.data());
        first_ = inHourClosestTo(datagram.captured, info_.microseconds);
        clock_ahead_ = first_ - datagram.captured;
        by_capture_ = clock_ == StampClock::Capture ||
                      (clock_ == StampClock::SensorIfClose && std::abs(clock_ahead_) > kClose);
    }

    void finish(ImportedItems& items, const WarningSink&) override
    {
        if (auto sweep = sweeps_.finish()) items.emplace_back(stamped(std::move(*sweep)));
    }

    std::vector<std::string> findings() const override
    {
        if (packets_ == 0) return {};
        std::vector<std::string> lines{
            "Velodyne " + nameOf(info_) + ": " + std::to_string(packets_) + " packets"};
        if (sweeps_.missing() > 0)
            lines.push_back(
                std::to_string(sweeps_.missing()) +
                " packets are missing in the capture, by the sensor's clock");
        char text[160];
        std::snprintf(
            text, sizeof text,
            by_capture_
                ? "stamps: when the capture says; the sensor's clock is %.3f s ahead (modulo 1 h)"
                : "stamps: the sensor's time past the hour, in the hour of the capture, whose "
                  "clock it is %.3f s ahead of",
            toSeconds(clock_ahead_));
        lines.emplace_back(text);
        return lines;
    }

 private:
    PacketScan stamped(VelodyneSweep sweep) const
    {
        sweep.scan.stamp = by_capture_ ? sweep.captured : first_ + sweep.scan.stamp;
        return std::move(sweep.scan);
    }

    StampClock clock_;
    bool by_capture_ = false;
    VelodyneSweeps sweeps_;
    std::size_t packets_ = 0;
    velodyne::PacketInfo info_;
    Time first_ = 0;  // of the first packet, by the sensor
    Duration clock_ahead_ = 0;
};
}  // namespace

std::unique_ptr<PacketDecoder> makeVelodyneDecoder(StampClock clock)
{
    return std::make_unique<VelodyneDecoder>(clock);
}
}  // namespace taut
