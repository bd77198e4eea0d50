#include <optional>
#include <utility>

#include "HesaiCorrection.h"
#include "Repetition.h"
#include "SweepStamps.h"
#include "taut/importing/pcap/PacketDecoder.h"
#include "taut/packets/hesai/FrameAssembler.h"

namespace taut
{
namespace
{
constexpr std::size_t kFewestBytes = 500;

std::string returnsText(int returns)
{
    if (returns == 1) return "one return";
    return returns == 2 ? "two returns" : "three returns";
}

class HesaiDecoder : public PacketDecoder
{
 public:
    HesaiDecoder(std::string recording, std::string correction, StampClock clock)
        : recording_(std::move(recording)), correction_(std::move(correction)), stamps_(clock)
    {
    }

    std::string make() const override { return "Hesai"; }

    bool recognises(const UdpDatagram& datagram) const override
    {
        const auto& bytes = datagram.payload;
        const bool has_header = bytes.size() > kFewestBytes && bytes[0] == 0xee && bytes[1] == 0xff;
        return has_header || hesai::modelOf(bytes.data(), bytes.size()).has_value();
    }

    void add(const UdpDatagram& datagram, ImportedItems& items) override
    {
        if (repetition_.is(datagram.payload)) return;
        const auto* packet = datagram.payload.data();
        const std::size_t bytes = datagram.payload.size();
        const hesai::PacketInfo info = hesai::packetInfo(packet, bytes);
        if (packets_ == 0 && (!frames_ || info.model != info_.model))
        {
            info_ = info;
            angles_ = findHesaiAngles(recording_, correction_, info.model);
            frames_.emplace(info.model, angles_.calibration);
        }
        frames_->add(packet, bytes, complete_);
        packets_++;
        giveComplete(items);
        stamps_.note(frames_->packetEnd(), datagram.captured);
    }

    void finish(ImportedItems& items, const WarningSink&) override
    {
        if (frames_) frames_->finish(complete_);
        giveComplete(items);
    }

    std::vector<std::string> findings() const override
    {
        if (packets_ == 0) return {};
        std::vector<std::string> lines{
            "Hesai " + hesai::nameOf(info_.model) + ", " + returnsText(info_.returns) + ": " +
                std::to_string(packets_) + " packets",
            angles_.path.empty() ? "angles: the data sheet's; --hesai-csv gives the sensor's own"
                                 : "angles: " + angles_.path,
            stamps_.finding()};
        repetition_.report(lines);
        return lines;
    }

 private:
    void giveComplete(ImportedItems& items)
    {
        for (Scan& scan : complete_)
        {
            stamps_.apply(scan);
            items.emplace_back(std::move(scan));
        }
        complete_.clear();
    }

    std::string recording_, correction_;
    Repetition repetition_;
    SweepStamps stamps_;
    std::size_t packets_ = 0;
    hesai::PacketInfo info_;  // of the first packet
    HesaiAngles angles_;
    std::optional<hesai::FrameAssembler> frames_;
    std::vector<Scan> complete_;
};
}  // namespace

std::unique_ptr<PacketDecoder> makeHesaiDecoder(
    const std::string& recording, const std::string& correction, StampClock clock)
{
    return std::make_unique<HesaiDecoder>(recording, correction, clock);
}
}  // namespace taut
