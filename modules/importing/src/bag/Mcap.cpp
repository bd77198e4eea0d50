#include <zlib.h>

#include <map>
#include <set>

#include "BagFile.h"
#include "BagReader.h"
#include "Decompress.h"

/** \file Mcap.cpp
 * MCAP, the container of ROS 2 (mcap.dev/spec): records of an opcode, a length and content. Read
 * from front to back; the summary at the end serves only for a quick look at the topics. */
namespace taut::bag
{
namespace
{
const std::string kMagic("\x89MCAP0\r\n", 8);

enum Opcode : std::uint8_t
{
    kFooter = 0x02,
    kSchema = 0x03,
    kChannel = 0x04,
    kMessage = 0x05,
    kChunk = 0x06,
    kStatistics = 0x0B,
    kDataEnd = 0x0F
};
constexpr std::uint64_t kFooterLength = 20, kRecordHead = 9;

std::string readText(ByteReader& reader)
{
    return reader.text(reader.number<std::uint32_t>());
}

/** What a file says of its channels. */
struct Channels
{
    struct Channel
    {
        BagTopic topic;
        std::uint16_t schema = 0;
        bool of_ros = false;
    };
    std::map<std::uint16_t, std::string> schemas;
    std::map<std::uint16_t, Channel> channels;
    std::map<std::uint16_t, std::uint64_t> counts;
    bool counted = false;

    /** Takes a record if it is of these. */
    void add(std::uint8_t opcode, Bytes content)
    {
        ByteReader reader(content);
        if (opcode == kSchema)
        {
            const auto id = reader.number<std::uint16_t>();
            schemas[id] = plainType(readText(reader));
        }
        else if (opcode == kChannel)
        {
            const auto id = reader.number<std::uint16_t>();
            Channel channel;
            channel.schema = reader.number<std::uint16_t>();
            channel.topic.name = readText(reader);
            const std::string encoding = readText(reader);
            channel.topic.wire = encoding == "ros1" ? Wire::Ros1 : Wire::Cdr;
            channel.of_ros = encoding == "ros1" || encoding == "cdr";
            channels[id] = channel;
        }
        else if (opcode == kStatistics)
        {
            reader.take(8 + 2 + 4 + 4 + 4 + 4 + 8 + 8);  // counts of records and times
            ByteReader map(reader.take(reader.number<std::uint32_t>()));
            counted = true;
            while (map.remaining() > 0)
            {
                const auto id = map.number<std::uint16_t>();
                counts[id] = map.number<std::uint64_t>();
            }
        }
    }

    std::vector<BagTopic> topics() const
    {
        std::vector<BagTopic> list;
        for (const auto& [id, channel] : channels)
        {
            list.push_back(channel.topic);
            const auto schema = schemas.find(channel.schema);  // may come after the channel
            if (channel.of_ros && schema != schemas.end()) list.back().type = schema->second;
            const auto count = counts.find(id);
            list.back().empty = counted && (count == counts.end() || count->second == 0);
        }
        return list;
    }
};

class Mcap : public BagReader
{
 public:
    Mcap(const std::string& path, WarningSink warn) : file_(path), warn_(std::move(warn))
    {
        if (file_.remaining() < kMagic.size()) throw std::runtime_error(path + " is no MCAP file");
        file_.skip(kMagic.size());
    }

    std::vector<BagTopic> topics() override
    {
        std::vector<BagTopic> topics = topicsOfSummary();
        if (!topics.empty()) return topics;
        Mcap scan(file_.path(), {});
        while (scan.next())
        {
        }
        return scan.channels_.topics();
    }

    void choose(const std::vector<std::string>& topics) override
    {
        chosen_ = std::set<std::string>(topics.begin(), topics.end());
    }

    std::optional<BagMessage> next() override
    {
        while (true)
        {
            if (auto message = nextOfChunk()) return message;
            if (at_end_) return {};
            try
            {
                if (auto message = readRecord()) return message;
            }
            catch (const std::runtime_error& e)
            {
                at_end_ = true;
                warn(
                    "bag_truncated", file_.path() + " can be read to byte " +
                                         std::to_string(file_.position()) + " of " +
                                         std::to_string(file_.size()) + ": " + e.what());
            }
        }
    }

    double progress() const override { return file_.progress(); }

 private:
    /** Empty if there is no summary, or none that can be read. */
    std::vector<BagTopic> topicsOfSummary()
    {
        const std::uint64_t position = file_.position();
        const std::uint64_t tail = kRecordHead + kFooterLength + kMagic.size();
        Channels summary;
        try
        {
            if (file_.remaining() < tail) return {};
            file_.seek(file_.size() - tail);
            const bool footer = file_.number<std::uint8_t>() == kFooter &&
                                file_.number<std::uint64_t>() == kFooterLength;
            const auto start = footer ? file_.number<std::uint64_t>() : 0;
            if (start > 0) file_.seek(start);
            while (start > 0 && file_.remaining() > tail)
            {
                const auto opcode = file_.number<std::uint8_t>();
                summary.add(opcode, file_.read(file_.number<std::uint64_t>(), buffer_));
            }
        }
        catch (const std::runtime_error&)
        {
            summary = {};
        }
        file_.seek(position);
        return summary.topics();
    }

    /** A message that stands outside of chunks, or nothing; opens a chunk. */
    std::optional<BagMessage> readRecord()
    {
        const auto opcode = file_.number<std::uint8_t>();
        const auto length = file_.number<std::uint64_t>();
        if (opcode == kChunk)
            openChunk(file_.read(length, buffer_));
        else if (opcode == kMessage)
            return message(file_.read(length, buffer_));
        else if (opcode == kSchema || opcode == kChannel)
            channels_.add(opcode, file_.read(length, buffer_));
        else if (opcode == kDataEnd || opcode == kFooter)
            at_end_ = true;
        else
            file_.skip(length);
        return {};
    }

    void openChunk(Bytes content)
    {
        try
        {
            ByteReader reader(content);
            reader.take(16);  // first and last time
            const auto size = reader.number<std::uint64_t>();
            const auto checksum = reader.number<std::uint32_t>();
            const std::string compression = readText(reader);
            Bytes records = reader.take(reader.number<std::uint64_t>());
            if (!compression.empty())
            {
                chunk_data_ = decompress(compression, records, size);
                records = {chunk_data_.data(), chunk_data_.size()};
            }
            if (checksum != 0 && checksum != crc32_z(0, records.data, records.size))
                throw std::runtime_error("its checksum is wrong");
            chunk_ = ByteReader(records);
        }
        catch (const std::runtime_error& e)
        {
            damaged(e.what());
        }
    }

    std::optional<BagMessage> nextOfChunk()
    {
        try
        {
            while (chunk_.remaining() > 0)
            {
                const auto opcode = chunk_.number<std::uint8_t>();
                const Bytes content = chunk_.take(chunk_.number<std::uint64_t>());
                if (opcode == kMessage)
                {
                    if (auto found = message(content)) return found;
                }
                else
                    channels_.add(opcode, content);
            }
        }
        catch (const std::runtime_error& e)
        {
            damaged(e.what());
            chunk_ = ByteReader({});
        }
        return {};
    }

    /** Nothing if it is of a topic that nobody wants. */
    std::optional<BagMessage> message(Bytes content) const
    {
        ByteReader reader(content);
        const auto id = reader.number<std::uint16_t>();
        reader.number<std::uint32_t>();  // sequence
        const auto received = reader.number<std::uint64_t>();
        reader.number<std::uint64_t>();  // time of publication: often the same
        const auto it = channels_.channels.find(id);
        if (it == channels_.channels.end())
            throw std::runtime_error("a message is of no known channel");
        const BagTopic& topic = it->second.topic;
        if (chosen_ && chosen_->count(topic.name) == 0) return {};
        return BagMessage{
            topic.name, topic.wire, static_cast<Time>(received), reader.take(reader.remaining())};
    }

    void damaged(const std::string& why)
    {
        warn(
            "bag_damaged", file_.path() + ": a chunk that ends at byte " +
                               std::to_string(file_.position()) + " is left out: " + why);
    }
    void warn(const std::string& kind, const std::string& text) const
    {
        if (warn_) warn_({0, kind, text});
    }

    BagFile file_;
    WarningSink warn_;
    bool at_end_ = false;
    std::optional<std::set<std::string>> chosen_;
    Channels channels_;
    std::vector<std::uint8_t> buffer_, chunk_data_;
    ByteReader chunk_{Bytes{}};
};
}  // namespace

std::unique_ptr<BagReader> openMcap(const std::string& path, const WarningSink& warn)
{
    return std::make_unique<Mcap>(path, warn);
}
}  // namespace taut::bag
