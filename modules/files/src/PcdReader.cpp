#include <lzf.h>

#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>

#include "numbers.h"
#include "taut/files/PcdFile.h"

namespace taut
{
namespace
{
/** What LZF makes of a byte at most: three bytes stand for 264. */
constexpr std::size_t kMostExpansion = 88;
}  // namespace

PcdReader::PcdReader(const std::string& path) : path_(path), in_(path, std::ios::binary)
{
    if (!in_) fail("cannot be opened");
    readHeader();
    if (data_ == Data::Binary) checkBinary();
    if (data_ == Data::Compressed) decompress();
}

void PcdReader::checkBinary()
{
    const auto header = static_cast<std::uintmax_t>(in_.tellg());
    const std::uintmax_t points = (std::filesystem::file_size(path_) - header) / row_bytes_;
    if (points < size_)
        fail("ends after " + std::to_string(points) + " of " + std::to_string(size_) + " points");
    bytes_.resize(row_bytes_);
}

/* After the header: the compressed and the whole number of bytes, 32 bits each, then the data, in
 * which each field of all points stands before the next field. */
void PcdReader::decompress()
{
    if (size_ == 0) return;
    const auto header = static_cast<std::uintmax_t>(in_.tellg());
    std::array<std::uint32_t, 2> sizes{};
    const std::uintmax_t left = std::filesystem::file_size(path_) - header;
    if (left < sizeof sizes ||
        !in_.read(
            reinterpret_cast<char*>(sizes.data()), static_cast<std::streamsize>(sizeof sizes)))
        fail("ends before the sizes of the compressed data");
    const std::size_t compressed = sizes[0], whole = sizes[1];
    if (compressed > left - sizeof sizes)
        fail(
            "ends after " + std::to_string(left - sizeof sizes) + " of " +
            std::to_string(compressed) + " bytes of compressed data");
    if (whole % row_bytes_ != 0 || whole / row_bytes_ != size_)
        fail(
            "states " + std::to_string(whole) + " bytes of data, but " + std::to_string(size_) +
            " points of " + std::to_string(row_bytes_) + " bytes each");
    if (whole > compressed * kMostExpansion)
        fail(
            "states " + std::to_string(whole) + " bytes of data, which " +
            std::to_string(compressed) + " compressed bytes cannot hold");
    std::vector<char> packed(compressed);
    if (!in_.read(packed.data(), static_cast<std::streamsize>(compressed)))
        fail("the compressed data cannot be read");
    bytes_.resize(whole);
    const unsigned int made = lzf_decompress(packed.data(), sizes[0], bytes_.data(), sizes[1]);
    if (made != whole) fail("the compressed data are damaged");
}

void PcdReader::fail(const std::string& cause) const
{
    throw std::runtime_error("PCD file '" + path_ + "': " + cause);
}

std::size_t PcdReader::number(const std::string& word) const
{
    std::size_t value = 0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc() || stop != end) fail("'" + word + "' in the header is no number");
    return value;
}

void PcdReader::readHeader()
{
    std::map<std::string, std::vector<std::string>> entries;
    while (entries.count("DATA") == 0)
    {
        if (!std::getline(in_, line_) || entries.size() > 20)
            fail("has no header that ends with 'DATA'");
        std::istringstream words(line_);
        std::string key, word;
        if (!(words >> key) || key.front() == '#') continue;
        auto& values = entries[key];
        while (words >> word) values.push_back(word);
    }
    if (entries["FIELDS"].empty()) fail("the header states no FIELDS");
    if (entries["POINTS"].size() != 1) fail("the header states no POINTS");
    size_ = number(entries["POINTS"][0]);
    setColumns(entries["FIELDS"], entries["SIZE"], entries["TYPE"], entries["COUNT"]);
    const std::string data = entries["DATA"].empty() ? "" : entries["DATA"][0];
    if (data == "binary")
        data_ = Data::Binary;
    else if (data == "binary_compressed")
        data_ = Data::Compressed;
    else if (data != "ascii")
        fail("DATA '" + data + "' is not supported: save it as binary or ascii");
}

void PcdReader::setColumns(
    const std::vector<std::string>& fields, const std::vector<std::string>& sizes,
    const std::vector<std::string>& types, const std::vector<std::string>& counts)
{
    const std::size_t n = fields.size();
    if (sizes.size() != n || types.size() != n || (!counts.empty() && counts.size() != n))
        fail("FIELDS, SIZE, TYPE and COUNT differ in length");
    for (std::size_t i = 0; i < n; i++)
    {
        Column column{types[i].front(), number(sizes[i])};
        const bool is_float = column.type == 'F' && (column.bytes == 4 || column.bytes == 8);
        const bool is_whole =
            (column.type == 'I' || column.type == 'U') &&
            (column.bytes == 1 || column.bytes == 2 || column.bytes == 4 || column.bytes == 8);
        if (!is_float && !is_whole)
            fail("field '" + fields[i] + "' is of type " + types[i] + " and size " + sizes[i]);
        const std::size_t count = counts.empty() ? 1 : number(counts[i]);
        if (count > 1000) fail("field '" + fields[i] + "' has too many values");
        column.before = row_bytes_;
        column.step = count * column.bytes;
        for (std::size_t k = 0; k < count; k++)
        {
            column.within = k * column.bytes;
            names_.push_back(k == 0 ? fields[i] : fields[i] + "[" + std::to_string(k) + "]");
            columns_.push_back(column);
            row_bytes_ += column.bytes;
        }
    }
    if (row_bytes_ == 0) fail("the header states no FIELDS");
}

bool PcdReader::next(std::vector<double>& row)
{
    if (done_ == size_) return false;
    row.resize(columns_.size());
    if (data_ == Data::Ascii)
        nextAscii(row);
    else if (data_ == Data::Binary)
        nextBinary(row);
    else
        nextDecompressed(row);
    done_++;
    return true;
}

void PcdReader::nextAscii(std::vector<double>& row)
{
    if (!std::getline(in_, line_))
        fail("ends after " + std::to_string(done_) + " of " + std::to_string(size_) + " points");
    if (!parseRow(line_, row))
        fail("point " + std::to_string(done_) + " is not a row of numbers: '" + line_ + "'");
}

void PcdReader::nextBinary(std::vector<double>& row)
{
    if (!in_.read(bytes_.data(), static_cast<std::streamsize>(bytes_.size())))
        fail("cannot be read at point " + std::to_string(done_));
    const char* p = bytes_.data();
    for (std::size_t i = 0; i < row.size(); i++)
    {
        row[i] = decode(columns_[i], p);
        p += columns_[i].bytes;
    }
}

void PcdReader::nextDecompressed(std::vector<double>& row) const
{
    for (std::size_t i = 0; i < row.size(); i++)
    {
        const Column& c = columns_[i];
        row[i] = decode(c, &bytes_[c.before * size_ + done_ * c.step + c.within]);
    }
}

double PcdReader::decode(const Column& column, const char* bytes) const
{
    const bool is_signed = column.type == 'I';
    if (column.type == 'F')
        return column.bytes == 4 ? valueAt<float>(bytes) : valueAt<double>(bytes);
    switch (column.bytes)
    {
        case 1:
            return is_signed ? valueAt<std::int8_t>(bytes) : valueAt<std::uint8_t>(bytes);
        case 2:
            return is_signed ? valueAt<std::int16_t>(bytes) : valueAt<std::uint16_t>(bytes);
        case 4:
            return is_signed ? valueAt<std::int32_t>(bytes) : valueAt<std::uint32_t>(bytes);
        default:
            return is_signed ? valueAt<std::int64_t>(bytes) : valueAt<std::uint64_t>(bytes);
    }
}
}  // namespace taut
