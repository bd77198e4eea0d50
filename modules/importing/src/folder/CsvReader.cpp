#include "CsvReader.h"

#include <charconv>
#include <limits>
#include <stdexcept>

#include "taut/core/ByteOrderMark.h"

namespace taut
{
namespace
{
constexpr const char* kBlank = " \t\r";
constexpr const char* kSeparators = ",; \t\r";
}  // namespace

double parseNumber(const std::string& text)
{
    if (text == "nan" || text == "NaN") return std::numeric_limits<double>::quiet_NaN();
    const char* begin = text.data() + (!text.empty() && text[0] == '+' ? 1 : 0);
    const char* end = text.data() + text.size();
    double value = 0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || stop != end || begin == end)
        throw std::invalid_argument("'" + text + "' is not a number");
    return value;
}

CsvReader::CsvReader(const std::string& path) : path_(path), file_(path)
{
    if (!file_) throw std::runtime_error("cannot read '" + path + "'");
    if (std::getline(file_, line_)) number_ = 1;
    dropByteOrderMark(line_);
    if (!line_.empty() && line_[0] == '#') line_[0] = ' ';
    split(columns_);
    if (columns_.empty())
        throw std::runtime_error("'" + path + "' does not begin with the names of its columns");
}

/* The next line that is neither empty nor a comment. */
bool CsvReader::readLine()
{
    while (std::getline(file_, line_))
    {
        number_++;
        const auto first = line_.find_first_not_of(kBlank);
        if (first != std::string::npos && line_[first] != '#') return true;
    }
    return false;
}

void CsvReader::split(std::vector<std::string>& row) const
{
    row.clear();
    for (auto begin = line_.find_first_not_of(kSeparators); begin != std::string::npos;)
    {
        const auto end = line_.find_first_of(kSeparators, begin);
        row.push_back(line_.substr(begin, end - begin));
        begin = line_.find_first_not_of(kSeparators, end);
    }
}

bool CsvReader::next(std::vector<std::string>& row)
{
    if (!readLine()) return false;
    split(row);
    if (row.size() != columns_.size())
        throw std::runtime_error(
            where() + ": " + std::to_string(row.size()) + " values in " +
            std::to_string(columns_.size()) + " columns");
    return true;
}

bool CsvReader::next(std::vector<double>& row)
{
    if (!next(words_)) return false;
    row.resize(words_.size());
    try
    {
        for (std::size_t i = 0; i < row.size(); i++) row[i] = parseNumber(words_[i]);
    }
    catch (const std::invalid_argument& e)
    {
        throw std::runtime_error(where() + ": " + e.what());
    }
    return true;
}
}  // namespace taut
