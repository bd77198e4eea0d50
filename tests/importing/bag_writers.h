#pragma once

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bag_messages.h"

/** \file bag_writers.h
 * A bag of ROS 1 and an MCAP file, as small as a reader needs them. */
namespace taut::test
{
struct TestMessage
{
    std::string topic, type;  //!< "package/Type"
    Time received = 0;
    Blob data;
};
using TestMessages = std::vector<TestMessage>;

inline void appendText(Blob& blob, const std::string& text)
{
    append(blob, static_cast<std::uint32_t>(text.size()));
    blob.insert(blob.end(), text.begin(), text.end());
}
inline void appendBlob(Blob& blob, const Blob& more)
{
    blob.insert(blob.end(), more.begin(), more.end());
}

inline Blob compress(const std::string& method, const Blob& in)
{
    if (method.empty() || method == "none") return in;
    Blob out(in.size() + in.size() / 10 + 1000);
    if (method == "bz2")
    {
        auto length = static_cast<unsigned>(out.size());
        BZ2_bzBuffToBuffCompress(
            reinterpret_cast<char*>(out.data()), &length,
            const_cast<char*>(reinterpret_cast<const char*>(in.data())),
            static_cast<unsigned>(in.size()), 9, 0, 0);
        out.resize(length);
    }
    else if (method == "lz4")
    {
        LZ4F_preferences_t preferences = {};
        preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;  // as roslz4 does
        out.resize(LZ4F_compressFrameBound(in.size(), &preferences));
        out.resize(LZ4F_compressFrame(out.data(), out.size(), in.data(), in.size(), &preferences));
    }
    else if (method == "zstd")
        out.resize(ZSTD_compress(out.data(), out.size(), in.data(), in.size(), 1));
    else
        throw std::logic_error(method);
    return out;
}

inline void writeFile(const std::string& path, const Blob& blob)
{
    std::ofstream(path, std::ios::binary)
        .write(
            reinterpret_cast<const char*>(blob.data()), static_cast<std::streamsize>(blob.size()));
}
inline Blob readFile(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/** Numbers of the topics, in the order of their appearance. */
inline std::map<std::string, std::uint16_t> numberTopics(const TestMessages& messages)
{
    std::map<std::string, std::uint16_t> ids;
    for (const auto& m : messages) ids.emplace(m.topic, static_cast<std::uint16_t>(ids.size()));
    return ids;
}

struct ContainerStyle
{
    std::string compression;            //!< of chunks: "", bz2, lz4, zstd; of messages for sqlite3
    std::size_t per_chunk = 5;          //!< messages in a chunk; 0: MCAP without chunks
    bool closed = true;                 //!< with index or summary
    std::size_t connections = 1;        //!< of each topic, that take turns
    bool channels_first = false;        //!< MCAP: before their schemas, in the summary
    std::string serialization = "cdr";  //!< as sqlite3 says
};

/** Number of the connection that the i-th message came by. */
inline std::uint16_t connectionOf(std::uint16_t topic, std::size_t i, const ContainerStyle& style)
{
    return static_cast<std::uint16_t>(topic * style.connections + i / 7 % style.connections);
}

/** A bag of ROS 1, format 2.0. */
class Ros1Writer
{
 public:
    static Blob bag(const TestMessages& messages, const ContainerStyle& style = {})
    {
        const auto ids = numberTopics(messages);
        Blob chunks, chunk, index;
        std::map<std::uint32_t, bool> introduced;
        std::uint32_t chunk_count = 0;
        for (std::size_t i = 0; i < messages.size(); i++)
        {
            const TestMessage& m = messages[i];
            const std::uint32_t id = connectionOf(ids.at(m.topic), i, style);
            if (!std::exchange(introduced[id], true))
            {
                const Blob connection = connectionRecord(id, m);
                appendBlob(chunk, connection);
                appendBlob(index, connection);
            }
            const auto seconds = static_cast<std::uint32_t>(m.received / 1'000'000'000);
            const auto nanoseconds = static_cast<std::uint32_t>(m.received % 1'000'000'000);
            Blob head;
            field(head, "op", std::uint8_t{2});
            field(head, "conn", id);
            field(head, "time", std::uint64_t{nanoseconds} << 32 | seconds);
            record(chunk, head, m.data);
            if ((i + 1) % style.per_chunk != 0 && i + 1 < messages.size()) continue;
            addChunk(chunks, chunk, style.compression);
            chunk_count++;
            chunk.clear();
        }
        const std::string magic = "#ROSBAG V2.0\n";
        Blob bag(magic.begin(), magic.end());
        Blob head;
        field(head, "op", std::uint8_t{3});
        field(head, "index_pos", std::uint64_t{style.closed ? 13 + 4096 + chunks.size() : 0});
        field(head, "conn_count", static_cast<std::uint32_t>(style.closed ? ids.size() : 0));
        field(head, "chunk_count", style.closed ? chunk_count : 0);
        record(bag, head, Blob(4096 - 8 - head.size(), ' '));
        appendBlob(bag, chunks);
        if (style.closed) appendBlob(bag, index);
        return bag;
    }

 private:
    template <class T>
    static void field(Blob& head, const std::string& name, T value)
    {
        Blob v;
        append(v, value);
        field(head, name, std::string(v.begin(), v.end()));
    }
    static void field(Blob& head, const std::string& name, const std::string& value)
    {
        appendText(head, name + "=" + value);
    }
    static void record(Blob& to, const Blob& head, const Blob& data)
    {
        append(to, static_cast<std::uint32_t>(head.size()));
        appendBlob(to, head);
        append(to, static_cast<std::uint32_t>(data.size()));
        appendBlob(to, data);
    }
    static Blob connectionRecord(std::uint32_t id, const TestMessage& m)
    {
        Blob head, data, all;
        field(head, "op", std::uint8_t{7});
        field(head, "conn", id);
        field(head, "topic", m.topic);
        field(data, "topic", m.topic);
        field(data, "type", m.type);
        field(data, "md5sum", std::string(32, '0'));
        field(data, "message_definition", "Header header\n");
        record(all, head, data);
        return all;
    }
    static void addChunk(Blob& to, const Blob& chunk, const std::string& compression)
    {
        Blob head;
        field(head, "op", std::uint8_t{5});
        field(head, "compression", compression.empty() ? "none" : compression);
        field(head, "size", static_cast<std::uint32_t>(chunk.size()));
        record(to, head, compress(compression, chunk));
        Blob index;
        field(index, "op", std::uint8_t{4});
        field(index, "ver", std::uint32_t{1});
        field(index, "conn", std::uint32_t{0});
        field(index, "count", std::uint32_t{0});
        record(to, index, {});
    }
};

/** An MCAP file; the wire of its messages is told by `encoding`: cdr or ros1. */
class McapWriter
{
 public:
    static Blob file(
        const TestMessages& messages, const ContainerStyle& style = {},
        const std::string& encoding = "cdr")
    {
        const auto ids = numberTopics(messages);
        Blob out{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
        const Blob magic = out;
        Blob header;
        appendText(header, "ros2");
        appendText(header, "test");
        record(out, 0x01, header);
        Blob chunk, schemas, channels;
        std::map<std::uint16_t, bool> introduced;
        for (std::size_t i = 0; i < messages.size(); i++)
        {
            const TestMessage& m = messages[i];
            Blob& to = style.per_chunk > 0 ? chunk : out;
            const std::uint16_t id = connectionOf(ids.at(m.topic), i, style);
            if (!std::exchange(introduced[id], true))
            {
                introduce(to, to, id, m, encoding);
                introduce(schemas, channels, id, m, encoding);
            }
            Blob content;
            append(content, id);
            append(content, static_cast<std::uint32_t>(i));
            append(content, static_cast<std::uint64_t>(m.received));
            append(content, static_cast<std::uint64_t>(m.received));
            appendBlob(content, m.data);
            record(to, 0x05, content);
            if (style.per_chunk == 0 || ((i + 1) % style.per_chunk != 0 && i + 1 < messages.size()))
                continue;
            addChunk(out, chunk, style.compression);
            chunk.clear();
        }
        if (!style.closed) return out;
        Blob end;
        append(end, std::uint32_t{0});
        record(out, 0x0F, end);
        Blob footer;
        append(footer, std::uint64_t{out.size()});
        append(footer, std::uint64_t{0});
        append(footer, std::uint32_t{0});
        appendBlob(out, style.channels_first ? channels : schemas);
        appendBlob(out, style.channels_first ? schemas : channels);
        record(out, 0x02, footer);
        appendBlob(out, magic);
        return out;
    }

 private:
    static void record(Blob& to, std::uint8_t opcode, const Blob& content)
    {
        to.push_back(opcode);
        append(to, std::uint64_t{content.size()});
        appendBlob(to, content);
    }
    static void introduce(
        Blob& schemas, Blob& channels, std::uint16_t id, const TestMessage& m,
        const std::string& encoding)
    {
        std::string type = m.type;
        if (encoding == "cdr") type.replace(type.find('/'), 1, "/msg/");
        Blob schema, channel;
        append(schema, static_cast<std::uint16_t>(id + 1));
        appendText(schema, type);
        appendText(schema, "ros2msg");
        appendText(schema, "std_msgs/Header header\n");
        record(schemas, 0x03, schema);
        append(channel, id);
        append(channel, static_cast<std::uint16_t>(id + 1));
        appendText(channel, m.topic);
        appendText(channel, encoding);
        append(channel, std::uint32_t{0});
        record(channels, 0x04, channel);
    }
    static void addChunk(Blob& to, const Blob& chunk, const std::string& compression)
    {
        Blob content;
        append(content, std::uint64_t{0});
        append(content, std::uint64_t{0});
        append(content, std::uint64_t{chunk.size()});
        append(content, static_cast<std::uint32_t>(crc32_z(0, chunk.data(), chunk.size())));
        appendText(content, compression);
        const Blob records = compress(compression, chunk);
        append(content, std::uint64_t{records.size()});
        appendBlob(content, records);
        record(to, 0x06, content);
        record(to, 0x07, Blob(14, 0));  // an index that nobody reads
    }
};
}  // namespace taut::test
