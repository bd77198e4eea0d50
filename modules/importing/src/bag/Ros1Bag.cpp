#include <algorithm>
#include <map>
#include <set>

#include "BagFile.h"
#include "BagReader.h"
#include "Decompress.h"

/** \file Ros1Bag.cpp
 * The bag format 2.0 of ROS 1: records of a header ("name=value" fields) and data; chunks hold
 * connections and messages. Read from front to back, so that no index is needed but for a quick
 * look at the topics. Source: wiki.ros.org/Bags/Format/2.0. */
namespace taut::bag
{
namespace
{
const std::string kMagic = "#ROSBAG V2.0\n";

enum Op : std::uint8_t
{
    kMessage = 2,
    kBagHeader = 3,
    kChunk = 5,
    kConnection = 7
};

/** The fields of a record's header. */
class Fields
{
 public:
    explicit Fields(Bytes bytes)
    {
        ByteReader reader(bytes);
        while (reader.remaining() > 0)
        {
            const std::string field = reader.text(reader.number<std::uint32_t>());
            const std::size_t equals = field.find('=');
            if (equals == std::string::npos)
                throw std::runtime_error("a record's header has no fields");
            values_[field.substr(0, equals)] = field.substr(equals + 1);
        }
    }

    std::string text(const std::string& name) const
    {
        const auto it = values_.find(name);
        return it == values_.end() ? std::string() : it->second;
    }

    template <class T>
    T number(const std::string& name) const
    {
        const std::string value = text(name);
        if (value.size() != sizeof(T))
            throw std::runtime_error("a record's header lacks the field '" + name + "'");
        return ByteReader::numberAt<T>(reinterpret_cast<const std::uint8_t*>(value.data()), false);
    }

 private:
    std::map<std::string, std::string> values_;
};

Time timeOf(std::uint64_t field)
{
    return Time(field & 0xFFFFFFFF) * 1'000'000'000 + Time(field >> 32);
}

class Ros1Bag : public BagReader
{
 public:
    Ros1Bag(const std::string& path, WarningSink warn) : file_(path), warn_(std::move(warn))
    {
        if (file_.remaining() < kMagic.size()) throw std::runtime_error(path + " is no ROS bag");
        file_.skip(kMagic.size());
        try
        {
            readBagHeader();
        }
        catch (const std::runtime_error& e)
        {
            throw std::runtime_error(path + " is damaged at its beginning: " + e.what());
        }
    }

    std::vector<BagTopic> topics() override
    {
        std::vector<BagTopic> topics = indexed_ ? topicsOfIndex() : std::vector<BagTopic>();
        if (!topics.empty()) return topics;
        Ros1Bag scan(file_.path(), {});
        while (scan.next())
        {
        }
        return scan.seen();
    }

    void choose(const std::vector<std::string>& topics) override
    {
        chosen_ = std::set<std::string>(topics.begin(), topics.end());
    }

    std::optional<BagMessage> next() override
    {
        while (!at_end_)
        {
            if (auto message = nextOfChunk()) return message;
            if (file_.remaining() == 0) break;
            try
            {
                readRecord();
            }
            catch (const std::runtime_error& e)
            {
                truncated(e.what());
            }
        }
        if (!at_end_ && indexed_ && chunks_read_ < chunks_expected_)
            truncated(
                "it has " + std::to_string(chunks_read_) + " chunks of " +
                std::to_string(chunks_expected_));
        at_end_ = true;
        return {};
    }

    double progress() const override { return file_.progress(); }

 private:
    void readBagHeader()
    {
        const Fields header(file_.read(file_.number<std::uint32_t>(), header_));
        if (header.number<std::uint8_t>("op") != kBagHeader)
            throw std::runtime_error("the first record is not the bag's header");
        if (!header.text("encryptor").empty())
            throw std::runtime_error("it is encrypted; decrypt it with rosbag decompress");
        index_position_ = header.number<std::uint64_t>("index_pos");
        chunks_expected_ = header.number<std::uint32_t>("chunk_count");
        file_.skip(file_.number<std::uint32_t>());
        indexed_ = index_position_ > 0;
        if (!indexed_ && warn_)
            warn_(
                {0, "bag_unindexed",
                 file_.path() + " was not closed and has no index: it is read as far as it is "
                                "complete; 'rosbag reindex' makes a whole bag of it"});
    }

    /** Empty if the index cannot be read. */
    std::vector<BagTopic> topicsOfIndex()
    {
        const std::uint64_t position = file_.position();
        std::map<std::uint32_t, BagTopic> found;
        try
        {
            file_.seek(index_position_);
            while (file_.remaining() > 0)
            {
                const Fields header(file_.read(file_.number<std::uint32_t>(), header_));
                const std::uint32_t length = file_.number<std::uint32_t>();
                if (header.number<std::uint8_t>("op") != kConnection) break;
                addConnection(header, file_.read(length, data_), found);
            }
        }
        catch (const std::runtime_error&)
        {
            found.clear();
        }
        file_.seek(position);
        return values(found);
    }

    static std::vector<BagTopic> values(const std::map<std::uint32_t, BagTopic>& connections)
    {
        std::vector<BagTopic> topics;
        for (const auto& [id, topic] : connections) topics.push_back(topic);
        return topics;
    }
    std::vector<BagTopic> seen() const { return values(connections_); }

    static void addConnection(
        const Fields& header, Bytes data, std::map<std::uint32_t, BagTopic>& to)
    {
        const std::string type = Fields(data).text("type");
        to[header.number<std::uint32_t>("conn")] = {
            header.text("topic"), plainType(type), Wire::Ros1, false};
    }

    void readRecord()
    {
        const Fields header(file_.read(file_.number<std::uint32_t>(), header_));
        const std::uint32_t length = file_.number<std::uint32_t>();
        const auto op = header.number<std::uint8_t>("op");
        if (op == kChunk)
        {
            const Bytes data = file_.read(length, data_);
            chunks_read_++;
            openChunk(header, data);
        }
        else if (op == kConnection)
            addConnection(header, file_.read(length, data_), connections_);
        else
            file_.skip(length);  // indexes
    }

    void openChunk(const Fields& header, Bytes data)
    {
        try
        {
            const std::string compression = header.text("compression");
            if (compression != "none")
            {
                chunk_data_ = decompress(compression, data, header.number<std::uint32_t>("size"));
                data = {chunk_data_.data(), chunk_data_.size()};
            }
            chunk_ = ByteReader(data);
        }
        catch (const std::runtime_error& e)
        {
            damaged(e.what());
        }
    }

    /** The next message of the chunk that is open. */
    std::optional<BagMessage> nextOfChunk()
    {
        try
        {
            while (chunk_.remaining() > 0)
            {
                const Fields header(chunk_.take(chunk_.number<std::uint32_t>()));
                const Bytes data = chunk_.take(chunk_.number<std::uint32_t>());
                const auto op = header.number<std::uint8_t>("op");
                if (op == kConnection) addConnection(header, data, connections_);
                if (op != kMessage) continue;
                const auto it = connections_.find(header.number<std::uint32_t>("conn"));
                if (it == connections_.end())
                    throw std::runtime_error("a message is of no known connection");
                if (chosen_ && chosen_->count(it->second.name) == 0) continue;
                return BagMessage{
                    it->second.name, Wire::Ros1, timeOf(header.number<std::uint64_t>("time")),
                    data};
            }
        }
        catch (const std::runtime_error& e)
        {
            damaged(e.what());
            chunk_ = ByteReader({});
        }
        return {};
    }

    void damaged(const std::string& why)
    {
        if (warn_)
            warn_(
                {0, "bag_damaged",
                 file_.path() + ": a chunk that ends at byte " + std::to_string(file_.position()) +
                     " is left out: " + why});
    }
    void truncated(const std::string& why)
    {
        at_end_ = true;
        if (warn_)
            warn_(
                {0, "bag_truncated",
                 file_.path() + " can be read to byte " + std::to_string(file_.position()) +
                     " of " + std::to_string(file_.size()) + ": " + why});
    }

    BagFile file_;
    WarningSink warn_;
    std::uint64_t index_position_ = 0;
    std::uint32_t chunks_expected_ = 0, chunks_read_ = 0;
    bool indexed_ = false, at_end_ = false;
    std::optional<std::set<std::string>> chosen_;
    std::map<std::uint32_t, BagTopic> connections_;
    std::vector<std::uint8_t> header_, data_, chunk_data_;
    ByteReader chunk_{Bytes{}};
};
}  // namespace

std::unique_ptr<BagReader> openRos1Bag(const std::string& path, const WarningSink& warn)
{
    return std::make_unique<Ros1Bag>(path, warn);
}
}  // namespace taut::bag
