#include "PcapSource.h"

#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "taut/importing/pcap/PacketDecoder.h"
#include "taut/packets/hesai/Correction.h"
#include "taut/packets/ouster/Decoder.h"

namespace taut
{
namespace
{
constexpr std::uint16_t kOusterPort = 7502;
constexpr std::size_t kSmallestLidar = 100;  // more than a packet of an IMU
constexpr std::size_t kLargestPlain = 1472;  // payload of one Ethernet frame

/** The sensors and other senders of a capture, as far as they were seen. */
class PcapSource : public ImportSource
{
 public:
    PcapSource(const Recording& recording, const ImportOptions& options, WarningSink warn)
        : path_(recording.path.string()), reader_(path_), warn_(std::move(warn))
    {
        const StampClock clock = options.capture_clock ? StampClock::Capture : StampClock::Sensor;
        addSensor(makeVelodyneDecoder(clock, true));
        if (const auto info = findDescription(recording.path, options))
        {
            addSensor(makeOusterDecoder(*info, clock));
            sensors_.back().from = senderOf(*sensors_.back().decoder);
            sensors_.back().unknown = !sensors_.back().from;
        }
        addSensor(makeHesaiDecoder(path_, options.hesai_csv, clock));
    }

    std::optional<ImportedItem> next() override
    {
        while (items_.empty() && !finished_)
        {
            if (const auto datagram = reader_.next())
                take(*datagram);
            else
                finish();
        }
        if (items_.empty()) return {};
        ImportedItem item = std::move(items_.front());
        items_.pop_front();
        return item;
    }

    double progress() const override { return reader_.progress(); }

    std::vector<std::string> findings() const override
    {
        std::vector<std::string> lines;
        for (const Sensor& sensor : sensors_)
        {
            for (auto& line : sensor.decoder->findings()) lines.push_back(std::move(line));
            if (sensor.decoded > 0 && sensor.foreign > 0)
                lines.push_back(
                    std::to_string(sensor.foreign) + " datagrams to the ports of the " +
                    sensor.decoder->make() + " are of something else and are left out");
        }
        return lines;
    }

 private:
    struct Sensor
    {
        std::unique_ptr<PacketDecoder> decoder;
        std::optional<std::uint32_t> from;
        std::size_t decoded = 0, bad = 0, others = 0, foreign = 0;
        bool unknown = false;  // described, but none of the senders is
    };

    void addSensor(std::unique_ptr<PacketDecoder> decoder)
    {
        sensors_.emplace_back();
        sensors_.back().decoder = std::move(decoder);
    }

    /** The first one in the capture whose packets can be of that sensor and no other. */
    std::optional<std::uint32_t> senderOf(const PacketDecoder& decoder) const
    {
        PcapReader reader(path_);
        const auto lidar_bytes = [&](const UdpDatagram& d)
        { return decoder.recognises(d) && d.payload.size() > kSmallestLidar; };
        while (const auto datagram = reader.next())
            if (lidar_bytes(*datagram) && decoder.misfit(*datagram).empty()) return datagram->from;
        return {};
    }

    std::optional<ouster::SensorInfo> findDescription(
        std::filesystem::path capture, const ImportOptions& options)
    {
        if (!options.ouster_json.empty()) return ouster::loadSensorInfo(options.ouster_json);
        capture.replace_extension(".json");
        if (!std::filesystem::exists(capture)) return {};
        try
        {
            return ouster::loadSensorInfo(capture.string());
        }
        catch (const std::runtime_error& e)  // it may well describe something else
        {
            no_description_ = e.what();
            return {};
        }
    }

    void take(const UdpDatagram& datagram)
    {
        for (Sensor& sensor : sensors_)
            if (sensor.decoder->recognises(datagram)) return decode(datagram, sensor);
        if (datagram.to_port == kOusterPort || datagram.payload.size() > kLargestPlain)
            perhaps_ouster_++;
    }

    void decode(const UdpDatagram& datagram, Sensor& sensor)
    {
        const std::string misfit = sensor.decoder->misfit(datagram);
        if (first_cause_.empty()) first_cause_ = misfit;
        const bool is_from_another = sensor.from && *sensor.from != datagram.from;
        if (!sensor.decoder->isOfItsKind(datagram))
        {
            sensor.foreign++;
            if (sensor.from && !is_from_another)
                warn({datagram.captured, "packet_invalid", misfit});
            return;
        }
        if (is_from_another || !misfit.empty())
        {
            if (sensor.others++ == 0) second_ = datagram.from;
            return;
        }
        try
        {
            sensor.decoder->add(datagram, items_);
            sensor.from = datagram.from;
            sensor.decoded++;
        }
        catch (const hesai::CorrectionError&)
        {
            throw;
        }
        catch (const ouster::DescriptionError& e)
        {
            throw std::runtime_error("'" + path_ + "': " + e.what());
        }
        catch (const std::runtime_error& e)
        {
            if (first_cause_.empty()) first_cause_ = e.what();
            sensor.bad++;
            if (sensor.decoded > 0) warn({datagram.captured, "packet_invalid", e.what()});
        }
    }

    void finish()
    {
        finished_ = true;
        std::size_t decoded = 0;
        for (const Sensor& sensor : sensors_) decoded += sensor.decoded;
        for (const Sensor& sensor : sensors_)
            if (sensor.unknown && sensor.others + sensor.foreign > 0)
                throw std::runtime_error("'" + path_ + "': " + first_cause_);
        if (decoded == 0) throw std::runtime_error(nothingFound());
        for (const Sensor& sensor : sensors_)
        {
            if (sensor.decoded > 0) sensor.decoder->finish(items_, warn_);
            if (sensor.others > 0)
                warn(
                    {0, "second_sensor",
                     std::to_string(sensor.others) + " packets of another " +
                         sensor.decoder->make() + ", at " + addressText(second_) +
                         ", are left out: the first one, at " + addressText(*sensor.from) +
                         ", is taken"});
        }
        reportDamage();
    }

    void reportDamage()
    {
        const auto& counts = reader_.counts();
        if (!reader_.damage().empty())
            warn(
                {0, "pcap_truncated",
                 "'" + path_ + "' cannot be read on after " + std::to_string(counts.records) +
                     " records: " + reader_.damage()});
        if (counts.cut > 0)
            warn(
                {0, "pcap_cut",
                 std::to_string(counts.cut) +
                     " records are not in the capture in whole: was it made with a snap length?"});
        if (counts.unfinished > 0)
            warn(
                {0, "fragments_lost",
                 std::to_string(counts.unfinished) +
                     " datagrams are left out, of which not all fragments were captured"});
    }

    std::string nothingFound() const
    {
        const auto& counts = reader_.counts();
        std::string text = "no packet of a known sensor in '" + path_ + "' (" +
                           std::to_string(counts.records) + " records, " +
                           std::to_string(counts.datagrams) + " UDP datagrams)";
        if (!reader_.damage().empty()) text += "; " + reader_.damage();
        if (!first_cause_.empty()) return text + ": " + first_cause_;
        if (perhaps_ouster_ == 0) return text;
        text += "; " + std::to_string(perhaps_ouster_) +
                " may be an Ouster's: give its description with --ouster-json";
        return no_description_.empty() ? text : text + " (" + no_description_ + ")";
    }

    void warn(const Warning& warning) const
    {
        if (warn_) warn_(warning);
    }

    std::string path_;
    PcapReader reader_;
    WarningSink warn_;
    std::vector<Sensor> sensors_;
    ImportedItems items_;
    bool finished_ = false;
    std::uint32_t second_ = 0;
    std::size_t perhaps_ouster_ = 0;
    std::string first_cause_, no_description_;
};
}  // namespace

bool isPcap(const Recording& recording)
{
    for (const char* magic :
         {"\xd4\xc3\xb2\xa1", "\xa1\xb2\xc3\xd4", "\x4d\x3c\xb2\xa1", "\xa1\xb2\x3c\x4d",
          "\x0a\x0d\x0d\x0a"})
        if (recording.head.compare(0, 4, magic) == 0) return true;
    return false;
}

std::unique_ptr<ImportSource> openPcap(
    const Recording& recording, const ImportOptions& options, const WarningSink& warn)
{
    return std::make_unique<PcapSource>(recording, options, warn);
}
}  // namespace taut
