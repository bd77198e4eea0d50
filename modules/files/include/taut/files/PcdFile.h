#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

/** \file PcdFile.h
 * Point clouds in PCD files of version 0.7 and before: "The PCD (Point Cloud Data) file format",
 * documentation of the Point Cloud Library. */
namespace taut
{
/** Reads the points of a PCD file one by one: ascii and binary, numbers of any type. */
class PcdReader
{
 public:
    /** Opens the file and reads its header. Throws std::runtime_error that names the file and the
     * cause: not there, not a PCD file, a format or field that cannot be read (compressed data is
     * not), fewer data than the header says. */
    explicit PcdReader(const std::string& path);

    /** Number of points. */
    std::size_t size() const { return size_; }

    /** Names of the columns; a field of several values has as many, "name", "name[1]", ... */
    const std::vector<std::string>& columns() const { return names_; }

    /** The next point: one value a column. False after the last one. Throws std::runtime_error with
     * the number of the point where the data end early or are not numbers. */
    bool next(std::vector<double>& row);

 private:
    struct Column
    {
        char type = 'F';  // I, U, F
        std::size_t bytes = 4;
    };

    void readHeader();
    void setColumns(
        const std::vector<std::string>& fields, const std::vector<std::string>& sizes,
        const std::vector<std::string>& types, const std::vector<std::string>& counts);
    void nextAscii(std::vector<double>& row);
    void nextBinary(std::vector<double>& row);
    double decode(const Column& column, const char* bytes) const;
    std::size_t number(const std::string& word) const;
    [[noreturn]] void fail(const std::string& cause) const;

    std::string path_;
    std::ifstream in_;
    bool ascii_ = false;
    std::size_t size_ = 0, done_ = 0, row_bytes_ = 0;
    std::vector<std::string> names_;
    std::vector<Column> columns_;
    std::vector<char> bytes_;  // of one point
    std::string line_;
};
}  // namespace taut
