#include "Repetition.h"
#include "SweepStamps.h"
#include "taut/importing/pcap/PacketDecoder.h"
#include "taut/packets/ouster/Decoder.h"

namespace taut
{
namespace
{
class OusterDecoder : public PacketDecoder
{
 public:
    OusterDecoder(const ouster::SensorInfo& info, StampClock clock)
        : info_(info), frames_(info), stamps_(clock)
    {
    }

    std::string make() const override { return "Ouster"; }

    bool recognises(const UdpDatagram& datagram) const override
    {
        return datagram.payload.size() == ouster::lidarPacketBytes(info_) ||
               datagram.to_port == info_.lidar_port || datagram.to_port == info_.imu_port;
    }

    bool isOfItsKind(const UdpDatagram& datagram) const override
    {
        return isImu(datagram) || datagram.payload.size() == ouster::lidarPacketBytes(info_);
    }

    std::string misfit(const UdpDatagram& datagram) const override
    {
        if (isImu(datagram)) return {};
        return ouster::misfit(info_, datagram.payload.data(), datagram.payload.size());
    }

    void add(const UdpDatagram& datagram, ImportedItems& items) override
    {
        if (repetition_.is(datagram.payload)) return;
        if (isImu(datagram))
            addImu(datagram, items);
        else
            addLidar(datagram, items);
    }

    void finish(ImportedItems& items, const WarningSink& warn) override
    {
        if (auto frame = frames_.finish()) give(std::move(*frame), items);
        if (frames_.lateColumns() > 0 && warn)
            warn(
                {0, "packets_late",
                 std::to_string(frames_.lateColumns()) +
                     " columns came after their turn was over; left out"});
        if (imu_packets_ == 0 && lidar_packets_ > 0 && warn)
            warn(
                {0, "no_imu",
                 "an Ouster measures rates and forces too, but the capture has no packet of that "
                 "on port " +
                     std::to_string(info_.imu_port)});
    }

    std::vector<std::string> findings() const override
    {
        if (lidar_packets_ + imu_packets_ == 0) return {};
        std::vector<std::string> lines{
            "Ouster " + info_.model + ": " + std::to_string(lidar_packets_) + " lidar and " +
            std::to_string(imu_packets_) + " IMU packets"};
        if (imu_packets_ > 0)
            lines.emplace_back("IMU: converted from g and deg/s, as the sensor gives them");
        if (incomplete_ > 0)
            lines.push_back(
                std::to_string(incomplete_) + " turns of " + std::to_string(turns_) +
                " have fewer than " + std::to_string(info_.columns_per_frame) + " columns");
        repetition_.report(lines);
        lines.push_back(stamps_.finding());
        return lines;
    }

 private:
    bool isImu(const UdpDatagram& datagram) const
    {
        return datagram.to_port == info_.imu_port && info_.imu_port != info_.lidar_port;
    }

    void addImu(const UdpDatagram& datagram, ImportedItems& items)
    {
        if (!info_.legacy_imu)
            throw std::runtime_error("its udp_profile_imu cannot be decoded here");
        if (datagram.payload.size() != ouster::kImuPacketBytes)
            throw std::runtime_error(
                "an IMU packet has " + std::to_string(datagram.payload.size()) +
                " bytes instead of 48");
        ImuSample sample = ouster::decodeImu(datagram.payload.data());
        imu_packets_++;
        sample.t = stamps_.of(sample.t, datagram.captured);
        items.emplace_back(sample);
    }

    void addLidar(const UdpDatagram& datagram, ImportedItems& items)
    {
        auto frame = frames_.add(datagram.payload.data(), datagram.payload.size());
        lidar_packets_++;
        if (frame) give(std::move(*frame), items);
        if (const auto t = frames_.packetTime()) stamps_.note(*t, datagram.captured);
    }

    void give(ouster::Frame frame, ImportedItems& items)
    {
        turns_++;
        if (frame.columns < info_.columns_per_frame) incomplete_++;
        stamps_.apply(frame.scan);
        items.emplace_back(std::move(frame.scan));
    }

    ouster::SensorInfo info_;
    Repetition repetition_;
    ouster::FrameAssembler frames_;
    SweepStamps stamps_;
    std::size_t lidar_packets_ = 0, imu_packets_ = 0, turns_ = 0, incomplete_ = 0;
};
}  // namespace

std::unique_ptr<PacketDecoder> makeOusterDecoder(const ouster::SensorInfo& info, StampClock clock)
{
    return std::make_unique<OusterDecoder>(info, clock);
}
}  // namespace taut
