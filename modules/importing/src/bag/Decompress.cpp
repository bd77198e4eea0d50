#include "Decompress.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>

namespace taut::bag
{
namespace
{
constexpr std::size_t kLargest = std::size_t{1} << 30;  // no recorder writes such chunks

/** What one call of a library took and gave. */
struct Step
{
    std::size_t consumed = 0, produced = 0;
    bool finished = false;
};

[[noreturn]] void throwDamaged(const std::string& why)
{
    throw std::runtime_error("its compressed data are damaged (" + why + ")");
}

class Bz2
{
 public:
    Bz2()
    {
        if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
    }
    ~Bz2() { BZ2_bzDecompressEnd(&stream_); }
    Bz2(const Bz2&) = delete;
    Bz2& operator=(const Bz2&) = delete;

    Step step(Bytes in, std::uint8_t* out, std::size_t room)
    {
        // The library reads only, but takes a pointer to char.
        stream_.next_in = const_cast<char*>(reinterpret_cast<const char*>(in.data));
        stream_.avail_in = static_cast<unsigned>(in.size);
        stream_.next_out = reinterpret_cast<char*>(out);
        stream_.avail_out = static_cast<unsigned>(room);
        const int result = BZ2_bzDecompress(&stream_);
        if (result != BZ_OK && result != BZ_STREAM_END) throwDamaged("bz2");
        return {in.size - stream_.avail_in, room - stream_.avail_out, result == BZ_STREAM_END};
    }

 private:
    bz_stream stream_ = {};
};

class Lz4
{
 public:
    Step step(Bytes in, std::uint8_t* out, std::size_t room)
    {
        std::size_t consumed = in.size, produced = room;
        const std::size_t result =
            LZ4F_decompress(context_.get(), out, &produced, in.data, &consumed, nullptr);
        if (LZ4F_isError(result)) throwDamaged(LZ4F_getErrorName(result));
        return {consumed, produced, result == 0};
    }

 private:
    struct Free
    {
        void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
    };
    static LZ4F_dctx* create()
    {
        LZ4F_dctx* context = nullptr;
        if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)))
            throw std::bad_alloc();
        return context;
    }
    std::unique_ptr<LZ4F_dctx, Free> context_{create()};
};

class Zstd
{
 public:
    Step step(Bytes in, std::uint8_t* out, std::size_t room)
    {
        ZSTD_inBuffer input{in.data, in.size, 0};
        ZSTD_outBuffer output{out, room, 0};
        const std::size_t result = ZSTD_decompressStream(context_.get(), &output, &input);
        if (ZSTD_isError(result)) throwDamaged(ZSTD_getErrorName(result));
        return {input.pos, output.pos, result == 0};
    }

 private:
    struct Free
    {
        void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
    };
    std::unique_ptr<ZSTD_DCtx, Free> context_{ZSTD_createDCtx()};
};

/** Feeds the codec until the stream ends, with an output that grows as it fills. */
template <class Codec>
std::vector<std::uint8_t> inflate(Bytes in, std::size_t limit)
{
    Codec codec;
    std::vector<std::uint8_t> out(std::min(limit, 4 * in.size + 4096));
    std::size_t filled = 0;
    while (true)
    {
        const Step step = codec.step(in, out.data() + filled, out.size() - filled);
        in.data += step.consumed;
        in.size -= step.consumed;
        filled += step.produced;
        if (step.finished) break;
        if (filled == out.size())
        {
            if (filled == limit) throwDamaged("longer than its header says");
            out.resize(std::min(limit, 2 * out.size()));
        }
        else if (step.consumed == 0 && step.produced == 0)
            throwDamaged("they end early");
    }
    out.resize(filled);
    return out;
}
}  // namespace

std::vector<std::uint8_t> decompress(
    const std::string& method, Bytes data, std::optional<std::size_t> expected)
{
    if (expected && *expected > kLargest) throwDamaged("too long");
    // One byte of room more: a stream tells that it ended only when asked once more.
    const std::size_t limit = expected.value_or(kLargest) + 1;
    std::vector<std::uint8_t> out;
    if (method == "bz2")
        out = inflate<Bz2>(data, limit);
    else if (method == "lz4")
        out = inflate<Lz4>(data, limit);
    else if (method == "zstd")
        out = inflate<Zstd>(data, limit);
    else
        throw std::runtime_error("its compression '" + method + "' is unknown");
    if (expected && out.size() != *expected) throwDamaged("they have another length");
    return out;
}

bool isZstd(Bytes data)
{
    return data.size >= 4 && ByteReader::numberAt<std::uint32_t>(data.data, false) == 0xFD2FB528;
}

Bytes plainMessage(Bytes message, std::vector<std::uint8_t>& buffer)
{
    if (!isZstd(message)) return message;
    buffer = decompress("zstd", message);
    return {buffer.data(), buffer.size()};
}
}  // namespace taut::bag
