#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

/** \file support.h
 * What the targets share. A target reads any bytes to their end, or refuses them with a
 * std::runtime_error; whatever else happens is a finding. */
namespace taut::fuzz
{
/** The bytes of one input, taken from the front. */
class Input
{
 public:
    Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

    const std::uint8_t* data() const { return data_; }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }

    /** The next byte; 0 at the end. */
    std::uint8_t byte()
    {
        if (size_ == 0) return 0;
        size_--;
        return *data_++;
    }

    /** Up to so many bytes. */
    Input take(std::size_t count)
    {
        const Input taken(data_, std::min(count, size_));
        data_ += taken.size_;
        size_ -= taken.size_;
        return taken;
    }

    /** A piece with its length before it (two bytes, the low one first), as joinPieces() writes. */
    Input piece()
    {
        const std::size_t low = byte(), high = byte();
        return take(low | high << 8);
    }

    std::string text() const { return {reinterpret_cast<const char*>(data_), size_}; }
    /** A copy, at whose end the address sanitizer stands guard. */
    std::vector<std::uint8_t> bytes() const { return {data_, data_ + size_}; }

 private:
    const std::uint8_t* data_;
    std::size_t size_;
};

/** Pieces of at most 65535 bytes, for Input::piece(). */
template <class Pieces>
std::string joinPieces(const Pieces& pieces)
{
    std::string joined;
    for (const auto& piece : pieces)
    {
        if (piece.size() > 0xffff) throw std::logic_error("a piece is too large");
        joined += static_cast<char>(piece.size() & 0xff);
        joined += static_cast<char>(piece.size() >> 8);
        joined.append(piece.begin(), piece.end());
    }
    return joined;
}

/** A folder of this process, for readers that want files; gone at the end. One that a finding ends
 * leaves it behind: run.sh gives it a TMPDIR that is removed. */
class Folder
{
 public:
    Folder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "taut_fuzz_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::logic_error("no folder for files");
        path_ = name;
    }
    ~Folder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    std::string path() const { return path_.string(); }

    /** Gives the path. Folders on the way are made. */
    std::string write(const std::string& name, const Input& content) const
    {
        const std::filesystem::path file = path_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream out(file, std::ios::binary | std::ios::trunc);
        out.write(
            reinterpret_cast<const char*>(content.data()),
            static_cast<std::streamsize>(content.size()));
        if (!out.flush()) throw std::logic_error("cannot write " + file.string());
        return file.string();
    }
    std::string write(const std::string& name, const std::string& content) const
    {
        return write(
            name, Input(reinterpret_cast<const std::uint8_t*>(content.data()), content.size()));
    }

    /** Writes one piece to each file; a file whose piece is empty is not there. */
    void writePieces(Input& input, const std::vector<std::string>& names) const
    {
        for (const std::string& name : names)
        {
            const Input content = input.piece();
            if (content.empty())
                std::filesystem::remove(path_ / name);
            else
                write(name, content);
        }
    }

 private:
    std::filesystem::path path_;
};

/** Ends the process with a finding. */
inline void require(bool condition, const char* what)
{
    if (condition) return;
    std::fprintf(stderr, "this must hold: %s\n", what);
    std::abort();
}

/** Calls `read`; true if it came to an end, false if it refused. */
template <class Read>
bool readOrRefuse(Read&& read)
{
    try
    {
        read();
        return true;
    }
    catch (const std::runtime_error&)
    {
        return false;
    }
}
}  // namespace taut::fuzz

/** Defines a target; `input` is what it gets. */
#define TAUT_FUZZ_TARGET(input)                                                       \
    static void fuzzTarget(taut::fuzz::Input input);                                  \
    extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) \
    {                                                                                 \
        fuzzTarget(taut::fuzz::Input(data, size));                                    \
        return 0;                                                                     \
    }                                                                                 \
    static void fuzzTarget(taut::fuzz::Input input)
