#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "BagFile.h"
#include "BagReader.h"

/** \file Sqlite3Bag.cpp
 * The sqlite3 container of ROS 2: a table of topics and one of messages, in the order of arrival.
 */
namespace taut::bag
{
namespace
{
constexpr std::int64_t kBeforeAll = std::numeric_limits<std::int64_t>::min();

class Sqlite3Bag : public BagReader
{
 public:
    Sqlite3Bag(const std::string& path, WarningSink warn) : path_(path), warn_(std::move(warn))
    {
        sqlite3* raw = nullptr;
        const int result = sqlite3_open_v2(path.c_str(), &raw, SQLITE_OPEN_READONLY, nullptr);
        db_.reset(raw);
        if (result != SQLITE_OK) fail();
        // A row cannot be longer than the file, whatever a damaged one claims.
        const auto size = std::filesystem::file_size(path);
        sqlite3_limit(
            raw, SQLITE_LIMIT_LENGTH,
            static_cast<int>(std::min<std::uintmax_t>(size + 1024, 1'000'000'000)));
        // So that a database that lost its end can be read as far as it goes; nothing is written.
        sqlite3_exec(raw, "PRAGMA writable_schema=ON", nullptr, nullptr, nullptr);
        checkLength(size);
        refuseViews();
        first_id_ = idAt("MIN");
        last_id_ = idAt("MAX");
    }

    std::vector<BagTopic> topics() override
    {
        const std::set<std::int64_t> in_use = topicsInUse();
        std::vector<BagTopic> topics;
        for (const auto& [id, topic] : readTopics())
        {
            topics.push_back(topic);
            topics.back().empty = in_use.count(id) == 0;
        }
        return topics;
    }

    void choose(const std::vector<std::string>& topics) override
    {
        for (const auto& [id, topic] : readTopics())
            if (std::find(topics.begin(), topics.end(), topic.name) != topics.end())
                chosen_[id] = topic.name;
        rows_ = prepare("SELECT id, topic_id, timestamp FROM messages ORDER BY id");
        data_ = prepare("SELECT data FROM messages WHERE id = ?");
    }

    std::optional<BagMessage> next() override
    {
        try
        {
            while (!at_end_ && step(rows_, now_id_))
            {
                const auto topic = chosen_.find(sqlite3_column_int64(rows_.get(), 1));
                if (topic == chosen_.end()) continue;
                return BagMessage{
                    topic->second, Wire::Cdr, sqlite3_column_int64(rows_.get(), 2),
                    dataOf(now_id_)};
            }
        }
        catch (const std::runtime_error& e)
        {
            warn(
                "bag_truncated", std::string(e.what()) + ": read up to message " +
                                     std::to_string(now_id_) + " of " + std::to_string(last_id_));
        }
        at_end_ = true;
        return {};
    }

    double progress() const override
    {
        if (last_id_ <= first_id_) return 0;
        // As doubles: any integer can be an identifier, and in a damaged file the last is not.
        const double first = static_cast<double>(first_id_), last = static_cast<double>(last_id_);
        return std::clamp((static_cast<double>(now_id_) - first) / (last - first), 0.0, 1.0);
    }

 private:
    struct Close
    {
        void operator()(sqlite3* db) const { sqlite3_close_v2(db); }
        void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    };
    using Statement = std::unique_ptr<sqlite3_stmt, Close>;

    /** The file's head tells how many pages there should be. */
    void checkLength(std::uintmax_t size)
    {
        BagFile file(path_);
        std::vector<std::uint8_t> buffer;
        if (size < 100) throw std::runtime_error(path_ + " is no sqlite3 database");
        const Bytes head = file.read(100, buffer);
        const auto page = ByteReader::numberAt<std::uint16_t>(head.data + 16, true);
        const auto pages = ByteReader::numberAt<std::uint32_t>(head.data + 28, true);
        const std::uintmax_t expected = std::uintmax_t{page == 1 ? 65536U : page} * pages;
        if (expected > size)
            warn(
                "bag_truncated", path_ + " has " + std::to_string(size) + " of " +
                                     std::to_string(expected) + " bytes; what is there is read");
    }

    /** A view can compute rows without end. */
    void refuseViews()
    {
        const auto views = prepare(
            "SELECT name FROM sqlite_master WHERE type = 'view' AND "
            "name COLLATE NOCASE IN ('messages', 'topics')");
        if (sqlite3_step(views.get()) == SQLITE_ROW)
            throw std::runtime_error(
                path_ + " is no ROS 2 bag: its '" + textAt(views, 0) + "' is no table");
    }

    /** The first or last identifier of a message; 0 if the database is damaged there. */
    std::int64_t idAt(const std::string& which)
    {
        const auto row = prepare("SELECT " + which + "(id) FROM messages");
        return sqlite3_step(row.get()) == SQLITE_ROW ? sqlite3_column_int64(row.get(), 0) : 0;
    }
    std::map<std::int64_t, BagTopic> readTopics()
    {
        std::map<std::int64_t, BagTopic> topics;
        const auto rows =
            prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
        for (std::int64_t id = kBeforeAll; step(rows, id);)
        {
            const std::string format = textAt(rows, 3);
            const bool cdr = format.empty() || format == "cdr";  // scripts leave it out
            topics[id] = {textAt(rows, 1), cdr ? plainType(textAt(rows, 2)) : "", Wire::Cdr, false};
        }
        return topics;
    }
    /** Those with messages, as far as the messages can be read. */
    std::set<std::int64_t> topicsInUse()
    {
        std::set<std::int64_t> topics;
        const auto rows = prepare("SELECT id, topic_id FROM messages ORDER BY id");
        try
        {
            for (std::int64_t id = kBeforeAll; step(rows, id);)
                topics.insert(sqlite3_column_int64(rows.get(), 1));
        }
        catch (const std::runtime_error&)
        {
        }
        return topics;
    }
    /** Valid until the next message is read. */
    Bytes dataOf(std::int64_t id)
    {
        sqlite3_reset(data_.get());
        sqlite3_bind_int64(data_.get(), 1, id);
        if (sqlite3_step(data_.get()) != SQLITE_ROW) fail();
        const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(data_.get(), 0));
        return {data, data ? static_cast<std::size_t>(sqlite3_column_bytes(data_.get(), 0)) : 0};
    }

    Statement prepare(const std::string& sql)
    {
        sqlite3_stmt* raw = nullptr;
        if (sqlite3_prepare_v2(db_.get(), sql.c_str(), -1, &raw, nullptr) != SQLITE_OK) fail();
        return Statement(raw);
    }
    /** The next row; its first column is `id`, which must grow: a damaged tree has circles. */
    bool step(const Statement& statement, std::int64_t& id)
    {
        const int result = sqlite3_step(statement.get());
        if (result == SQLITE_DONE) return false;
        if (result != SQLITE_ROW) fail();
        const std::int64_t last = id;
        id = sqlite3_column_int64(statement.get(), 0);
        if (id <= last) throw std::runtime_error(path_ + " is damaged: its rows are not in order");
        return true;
    }
    static std::string textAt(const Statement& row, int column)
    {
        const auto* text = sqlite3_column_text(row.get(), column);
        return text ? reinterpret_cast<const char*>(text) : std::string();
    }
    [[noreturn]] void fail()
    {
        throw std::runtime_error(
            path_ + " cannot be read as a ROS 2 bag: " + sqlite3_errmsg(db_.get()));
    }
    void warn(const std::string& kind, const std::string& text) const
    {
        if (warn_) warn_({0, kind, text});
    }

    std::string path_;
    WarningSink warn_;
    std::unique_ptr<sqlite3, Close> db_;
    Statement rows_, data_;  // after the database, to go before it
    std::map<std::int64_t, std::string> chosen_;
    std::int64_t first_id_ = 0, last_id_ = 0, now_id_ = kBeforeAll;
    bool at_end_ = false;
};
}  // namespace

std::unique_ptr<BagReader> openSqlite3Bag(const std::string& path, const WarningSink& warn)
{
    return std::make_unique<Sqlite3Bag>(path, warn);
}
}  // namespace taut::bag
