#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace taut
{
/** Reads a table of text line by line: a first line with the names of the columns, then values;
 * separated by commas, semicolons, tabs or blanks. Lines that begin with '#' are comments, but for
 * the first one. */
class CsvReader
{
 public:
    /** Throws std::runtime_error naming the file if it cannot be read or has no columns. */
    explicit CsvReader(const std::string& path);

    const std::vector<std::string>& columns() const { return columns_; }

    /** The next line's values as they are written; false at the end. Throws std::runtime_error
     * naming the line if it has another number of values than there are columns; the line after it
     * can be read. */
    bool next(std::vector<std::string>& row);

    /** The same as numbers. */
    bool next(std::vector<double>& row);

    /** "FILE:LINE", of the line read last. */
    std::string where() const { return path_ + ":" + std::to_string(number_); }

 private:
    bool readLine();
    void split(std::vector<std::string>& row) const;

    std::string path_;
    std::ifstream file_;
    std::vector<std::string> columns_;
    std::string line_;
    std::vector<std::string> words_;
    std::size_t number_ = 0;
};

/** A decimal number, by any locale. Throws std::invalid_argument. */
double parseNumber(const std::string& text);
}  // namespace taut
