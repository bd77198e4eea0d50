#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "Repetition.h"
#include "SweepStamps.h"
#include "VelodyneSweeps.h"
#include "taut/packets/velodyne/FrameAssembler.h"

namespace taut
{
namespace
{
constexpr Duration kHour = 3'600'000'000'000;

/** The time with these microseconds past the hour that is closest to `near`. */
Time inHourClosestTo(Time near, std::uint32_t microseconds)
{
    const Time t = near / kHour * kHour + static_cast<Time>(microseconds) * 1000;
    if (t - near > kHour / 2) return t - kHour;
    return near - t > kHour / 2 ? t + kHour : t;
}

std::string nameOf(velodyne::Model model)
{
    switch (model)
    {
        case velodyne::Model::Hdl32:
            return "HDL-32E";
        case velodyne::Model::Vlp16:
            return "VLP-16";
        case velodyne::Model::Vlp32:
            return "VLP-32C";
        case velodyne::Model::Vls128:
            break;
    }
    return "VLS-128";
}

std::string nameOf(velodyne::ReturnMode mode)
{
    switch (mode)
    {
        case velodyne::ReturnMode::Strongest:
            return "strongest return";
        case velodyne::ReturnMode::Last:
            return "last return";
        case velodyne::ReturnMode::Dual:
            break;
    }
    return "dual return";
}

/** True if other readers of rawlogs know such packets. */
bool isKnownToOthers(velodyne::Model model)
{
    return model == velodyne::Model::Vlp16 || model == velodyne::Model::Hdl32;
}

class VelodyneDecoder : public PacketDecoder
{
 public:
    VelodyneDecoder(StampClock clock, bool keep_packets)
        : keep_packets_(keep_packets), stamps_(clock)
    {
    }

    std::string make() const override { return "Velodyne"; }

    bool recognises(const UdpDatagram& datagram) const override
    {
        const auto& bytes = datagram.payload;
        return bytes.size() == velodyne::kPacketBytes && bytes[0] == 0xff && bytes[1] == 0xee;
    }

    void add(const UdpDatagram& datagram, ImportedItems& items) override
    {
        if (repetition_.is(datagram.payload)) return;
        velodyne::Packet packet;
        std::copy(datagram.payload.begin(), datagram.payload.end(), packet.begin());
        const auto info = velodyne::packetInfo(packet.data());
        if (packets_ == 0)
            begin(info, datagram.captured);
        else if (info.model != info_.model)
            throw std::runtime_error("a packet is of another model of Velodyne");
        if (frames_)
            addPoints(packet, datagram.captured, items);
        else if (auto sweep = sweeps_.add(packet, datagram.captured))
            items.emplace_back(stamped(std::move(*sweep)));
        packets_++;
    }

    void finish(ImportedItems& items, const WarningSink&) override
    {
        if (auto sweep = sweeps_.finish()) items.emplace_back(stamped(std::move(*sweep)));
        if (frames_) frames_->finish(complete_);
        giveComplete(items);
    }

    std::vector<std::string> findings() const override
    {
        if (packets_ == 0) return {};
        std::vector<std::string> lines{
            "Velodyne " + nameOf(info_.model) + ", " + nameOf(info_.mode) + ": " +
            std::to_string(packets_) + " packets"};
        if (sweeps_.missing() > 0)
            lines.push_back(
                std::to_string(sweeps_.missing()) +
                " packets are missing in the capture, by the sensor's clock");
        char text[160];
        std::snprintf(
            text, sizeof text,
            stamps_.byCapture()
                ? "stamps: when the capture says; the sensor's clock is %.3f s ahead (modulo 1 h)"
                : "stamps: the sensor's time past the hour, in the hour of the capture, whose "
                  "clock it is %.3f s ahead of",
            toSeconds(clock_ahead_));
        lines.emplace_back(text);
        repetition_.report(lines);
        return lines;
    }

 private:
    void begin(const velodyne::PacketInfo& info, Time captured)
    {
        info_ = info;
        first_ = inHourClosestTo(captured, info.microseconds);
        clock_ahead_ = first_ - captured;
        stamps_.decide(first_, captured);
        frames_.reset();
        if (!keep_packets_ || !isKnownToOthers(info.model))
            frames_.emplace(info.model, velodyne::defaultCalibration(info.model));
    }

    void addPoints(const velodyne::Packet& packet, Time captured, ImportedItems& items)
    {
        frames_->add(packet.data(), complete_);
        giveComplete(items);
        stamps_.note(first_ + frames_->packetEnd(), captured);
    }

    void giveComplete(ImportedItems& items)
    {
        for (Scan& scan : complete_)
        {
            scan.stamp += first_;
            scan.end += first_;
            stamps_.apply(scan);
            items.emplace_back(std::move(scan));
        }
        complete_.clear();
    }

    PacketScan stamped(VelodyneSweep sweep) const
    {
        sweep.scan.stamp = stamps_.byCapture() ? sweep.captured : first_ + sweep.scan.stamp;
        return std::move(sweep.scan);
    }

    bool keep_packets_;
    Repetition repetition_;
    SweepStamps stamps_;
    VelodyneSweeps sweeps_;
    std::optional<velodyne::FrameAssembler> frames_;  // that become points
    std::vector<Scan> complete_;
    std::size_t packets_ = 0;
    velodyne::PacketInfo info_;
    Time first_ = 0;  // of the first packet, by the sensor
    Duration clock_ahead_ = 0;
};
}  // namespace

std::unique_ptr<PacketDecoder> makeVelodyneDecoder(StampClock clock, bool keep_packets)
{
    return std::make_unique<VelodyneDecoder>(clock, keep_packets);
}
}  // namespace taut
