#include <charconv>
#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>

#include "numbers.h"
#include "taut/files/PcdFile.h"

namespace taut
{
PcdReader::PcdReader(const std::string& path) : path_(path), in_(path, std::ios::binary)
{
    if (!in_) fail("cannot be opened");
    readHeader();
    if (ascii_) return;
    const auto header = static_cast<std::uintmax_t>(in_.tellg());
    const std::uintmax_t points = (std::filesystem::file_size(path_) - header) / row_bytes_;
    if (points < size_)
        fail("ends after " + std::to_string(points) + " of " + std::to_string(size_) + " points");
    bytes_.resize(row_bytes_);
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
    ascii_ = data == "ascii";
    if (!ascii_ && data != "binary")
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
        const Column column{types[i].front(), number(sizes[i])};
        const bool is_float = column.type == 'F' && (column.bytes == 4 || column.bytes == 8);
        const bool is_whole =
            (column.type == 'I' || column.type == 'U') &&
            (column.bytes == 1 || column.bytes == 2 || column.bytes == 4 || column.bytes == 8);
        if (!is_float && !is_whole)
            fail("field '" + fields[i] + "' is of type " + types[i] + " and size " + sizes[i]);
        const std::size_t count = counts.empty() ? 1 : number(counts[i]);
        if (count > 1000) fail("field '" + fields[i] + "' has too many values");
        for (std::size_t k = 0; k < count; k++)
        {
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
    if (ascii_)
        nextAscii(row);
    else
        nextBinary(row);
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
