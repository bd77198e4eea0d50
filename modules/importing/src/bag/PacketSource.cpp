#include "PacketSource.h"

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <utility>

#include "Decompress.h"
#include "LidarPose.h"
#include "Messages.h"
#include "OusterDescription.h"
#include "SortedBag.h"
#include "TopicChoice.h"
#include "taut/importing/pcap/PacketDecoder.h"
#include "taut/packets/hesai/Correction.h"
#include "taut/packets/ouster/Decoder.h"

namespace taut::bag
{
namespace
{
constexpr Time kLatest = 4'600'000'000'000'000'000;  // ns: beyond what a stamp can be
const std::string kImuType = "sensor_msgs/Imu";

using Decoders = std::vector<std::unique_ptr<PacketDecoder>>;

/** The topic of the readings: of an IMU, or of the one in the Ouster. */
std::optional<BagTopic> chooseImu(
    const std::vector<BagTopic>& topics, const BagTopic& lidar, const ImportOptions& options)
{
    std::vector<BagTopic> candidates;
    std::vector<std::string> types{kImuType};
    if (isOusterPacketType(lidar.type)) types.push_back(lidar.type);
    for (const BagTopic& topic : topics)
        if (topic.type == kImuType || isOusterImu(topic)) candidates.push_back(topic);
    return chooseTopic(candidates, types, options.imu_topic, "--imu-topic");
}

class PacketSource : public ImportSource
{
 public:
    PacketSource(
        std::string path, std::unique_ptr<BagReader> reader, BagTopic lidar,
        std::optional<BagTopic> imu, Duration lidar_clock_offset, const WarningSink& warn)
        : path_(std::move(path)),
          lidar_(std::move(lidar)),
          imu_(std::move(imu)),
          bag_(path_, std::move(reader), lidar_, imu_, lidar_clock_offset, warn),
          warn_(warn)
    {
    }

    /** Of what the LiDAR's topic may hold; ports are those that the decoder of an Ouster knows its
     * packets by. */
    void decodeBy(Decoders decoders, std::uint16_t lidar_port = 0, std::uint16_t imu_port = 0)
    {
        decoders_ = std::move(decoders);
        lidar_port_ = lidar_port;
        imu_port_ = imu_port;
    }

    /** Nothing is taken from it where the sensor itself tells the pose. */
    void placeBy(LidarPose pose) { pose_ = std::move(pose); }

    std::optional<ImportedItem> next() override
    {
        while (items_.empty() && !finished_)
        {
            if (const auto message = bag_.next())
                take(*message);
            else
                finish();
        }
        if (items_.empty()) return {};
        ImportedItem item = std::move(items_.front());
        items_.pop_front();
        if (auto* scan = std::get_if<Scan>(&item); scan != nullptr && pose_.T_imu_lidar)
            scan->T_imu_lidar = *pose_.T_imu_lidar;
        readings_ += std::holds_alternative<ImuSample>(item) ? 1 : 0;
        return item;
    }

    double progress() const override { return bag_.progress(); }

    std::vector<std::string> findings() const override
    {
        std::vector<std::string> lines{"LiDAR: topic " + describe({lidar_})};
        if (imu_) lines.push_back("IMU: topic " + describe({*imu_}));
        lines.insert(lines.end(), bag_.findings().begin(), bag_.findings().end());
        if (!pose_.finding.empty()) lines.push_back(pose_.finding);
        for (const auto& decoder : decoders_)
            for (std::string& line : decoder->findings()) lines.push_back(std::move(line));
        return lines;
    }

    bool tellsPose() const override { return pose_.finding.empty() || pose_.T_imu_lidar; }

 private:
    void take(const BagMessage& message)
    {
        const Time received = std::clamp<Time>(message.received, 0, kLatest);
        try
        {
            std::vector<std::uint8_t> buffer;
            const WireReader reader(plainMessage(message.data, buffer), message.wire);
            if (imu_ && message.topic == imu_->name)
                takeReading(reader, received);
            else
                for (const RawPacket& packet : readPackets(lidar_.type, reader))
                    decode(packet, received, lidar_port_);
        }
        catch (const ouster::DescriptionError& e)
        {
            throw std::runtime_error(path_ + ": " + e.what());
        }
        catch (const hesai::CorrectionError&)
        {
            throw;
        }
        catch (const std::runtime_error& e)
        {
            fail(received, "message_invalid", message.topic, e.what());
        }
    }

    void takeReading(const WireReader& reader, Time received)
    {
        if (imu_->type != kImuType)
        {
            for (const RawPacket& packet : readPackets(imu_->type, reader))
                decode(packet, received, imu_port_);
            return;
        }
        const ImuSample sample = readImu(reader);
        if (sample.t != 0)
            items_.emplace_back(sample);
        else
            report(0, "no_stamp", imu_->name + ": a message has no stamp and is left out");
    }

    void decode(RawPacket packet, Time received, std::uint16_t port)
    {
        if (packet.data.size % 4 == 1 && isOusterPacketType(lidar_.type))
            packet.data.size--;  // old drivers append a byte
        UdpDatagram datagram;
        datagram.captured = packet.stamp > 0 ? std::min(packet.stamp, kLatest) : received;
        datagram.to_port = port;
        datagram.payload.assign(packet.data.data, packet.data.data + packet.data.size);
        const auto decoder = std::find_if(
            decoders_.begin(), decoders_.end(),
            [&](const auto& d) { return d->recognises(datagram); });
        try
        {
            if (decoder == decoders_.end())
                throw std::runtime_error(
                    "a packet of " + std::to_string(datagram.payload.size()) +
                    " bytes is of no known sensor");
            (*decoder)->add(datagram, items_);
            decoded_ += port == lidar_port_ ? 1 : 0;
        }
        catch (const ouster::DescriptionError&)
        {
            throw;
        }
        catch (const hesai::CorrectionError&)
        {
            throw;
        }
        catch (const std::runtime_error& e)
        {
            fail(datagram.captured, "packet_invalid", lidar_.name, e.what());
        }
    }

    void finish()
    {
        finished_ = true;
        if (decoded_ == 0)
            throw std::runtime_error(
                path_ + ": no packet of " + lidar_.name + " can be used" +
                (first_cause_.empty() ? "" : ": " + first_cause_));
        for (const auto& decoder : decoders_)
            decoder->finish(
                items_,
                [this](const Warning& w)
                {
                    if (w.kind != "no_imu") report(w.t, w.kind.c_str(), w.text);
                });
        if (readings_ == 0)
            report(
                0, "no_imu",
                path_ + ": " +
                    (imu_ ? "no reading of the IMU on " + imu_->name
                          : "no topic of an IMU (sensor_msgs/Imu)"));
    }

    void fail(Time t, const char* kind, const std::string& where, const std::string& what)
    {
        if (first_cause_.empty()) first_cause_ = what;
        report(t, kind, where + ": " + what);
    }

    void report(Time t, const char* kind, const std::string& text) const
    {
        if (warn_) warn_({t, kind, text});
    }

    std::string path_;
    BagTopic lidar_;
    std::optional<BagTopic> imu_;
    SortedBag bag_;
    WarningSink warn_;
    LidarPose pose_;
    Decoders decoders_;
    std::uint16_t lidar_port_ = 0, imu_port_ = 0;
    ImportedItems items_;
    std::string first_cause_;
    bool finished_ = false;
    std::size_t decoded_ = 0, readings_ = 0;
};
}  // namespace

bool isOusterImu(const BagTopic& topic)
{
    return isOusterPacketType(topic.type) && topic.name.find("imu") != std::string::npos;
}

std::unique_ptr<ImportSource> openPackets(
    const std::string& path, std::unique_ptr<BagReader> reader, const std::vector<BagTopic>& topics,
    const BagTopic& lidar, const ImportOptions& options, const WarningSink& warn)
{
    const auto imu = chooseImu(topics, lidar, options);
    // Other sensors have the stamps of the computer that recorded the bag.
    const bool of_one_clock = imu && isOusterImu(*imu);
    const StampClock clock = options.capture_clock ? StampClock::Capture
                             : of_one_clock        ? StampClock::Sensor
                                                   : StampClock::SensorIfClose;
    auto source = std::make_unique<PacketSource>(
        path, std::move(reader), lidar, imu, fromSeconds(options.lidar_clock_offset), warn);
    if (imu && !of_one_clock && !options.pose_given)
        source->placeBy(findLidarPose(path, topics, lidar, *imu, warn));
    Decoders decoders;
    if (isOusterPacketType(lidar.type))
    {
        const auto info = findOusterDescription(path, topics, lidar, options.ouster_json);
        decoders.push_back(makeOusterDecoder(info, clock));
        source->decodeBy(std::move(decoders), info.lidar_port, info.imu_port);
        return source;
    }
    decoders.push_back(makeHesaiDecoder(path, options.hesai_csv, clock));
    decoders.push_back(makeVelodyneDecoder(clock, false));
    source->decodeBy(std::move(decoders));
    return source;
}
}  // namespace taut::bag
