#pragma once

#include <sqlite3.h>

#include "bag_writers.h"

namespace taut::test
{
/** A sqlite3 database as rosbag2 writes it. */
inline void writeSqlite3Bag(
    const std::string& path, const TestMessages& messages, const ContainerStyle& style = {})
{
    sqlite3* db = nullptr;
    sqlite3_open(path.c_str(), &db);
    const auto run = [&](const std::string& sql)
    {
        if (sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
            throw std::logic_error(sqlite3_errmsg(db));
    };
    run("PRAGMA synchronous=OFF;CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type "
        "TEXT NOT NULL,"
        "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,"
        "timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
        "CREATE INDEX timestamp_idx ON messages (timestamp ASC);BEGIN");
    const auto ids = numberTopics(messages);
    std::map<int, bool> introduced;
    for (std::size_t i = 0; i < messages.size(); i++)
    {
        const TestMessage& m = messages[i];
        const int id = connectionOf(ids.at(m.topic), i, style) + 1;
        if (!std::exchange(introduced[id], true))
        {
            std::string type = m.type;
            type.replace(type.find('/'), 1, "/msg/");
            run("INSERT INTO topics VALUES(" + std::to_string(id) + ",'" + m.topic + "','" + type +
                "','" + style.serialization + "','')");
        }
        const Blob data = compress(style.compression, m.data);
        sqlite3_stmt* insert = nullptr;
        sqlite3_prepare_v2(
            db, "INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)", -1, &insert,
            nullptr);
        sqlite3_bind_int(insert, 1, id);
        sqlite3_bind_int64(insert, 2, m.received);
        sqlite3_bind_blob(insert, 3, data.data(), static_cast<int>(data.size()), SQLITE_STATIC);
        sqlite3_step(insert);
        sqlite3_finalize(insert);
    }
    run("COMMIT");
    sqlite3_close(db);
}
}  // namespace taut::test
