#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace taut
{
/** Reads a table of comma-separated values row by row; values may stand in quotes. */
class CsvRows
{
 public:
    /** Reads the names of the columns. Throws std::runtime_error if the file cannot be read. */
    explicit CsvRows(const std::string& path);

    /** Column of that name; -1 if there is none. */
    int column(const std::string& name) const;

    /** The next row; false after the last. A last row that was cut short ends the table. */
    bool next(std::vector<std::string>& row);

 private:
    static std::vector<std::string> split(const std::string& line);

    std::ifstream file_;
    std::vector<std::string> names_;
};
}  // namespace taut
