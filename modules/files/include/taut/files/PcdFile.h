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
/** Reads the points of a PCD file one by one: ascii, binary and binary_compressed, numbers of any
 * type. A compressed file is decompressed as a whole; the others are read as they are asked for. */
class PcdReader
{
 public:
    /** Opens the file and reads its header. Throws std::runtime_error that names the file and the
     * cause: not there, not a PCD file, a format or field that cannot be read, fewer data than the
     * header says, compressed data that are damaged or that give another number of bytes. */
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
        // [bytes] of a point: those of the fields before this one, those of the values of this
        // field before this one, those of the whole field
        std::size_t before = 0, within = 0, step = 0;
    };
    enum class Data
    {
        Ascii,
        Binary,
        Compressed
    };

    void readHeader();
    void checkBinary();
    void decompress();
    void setColumns(
        const std::vector<std::string>& fields, const std::vector<std::string>& sizes,
        const std::vector<std::string>& types, const std::vector<std::string>& counts);
    void nextAscii(std::vector<double>& row);
    void nextBinary(std::vector<double>& row);
    void nextDecompressed(std::vector<double>& row) const;
    double decode(const Column& column, const char* bytes) const;
    std::size_t number(const std::string& word) const;
    [[noreturn]] void fail(const std::string& cause) const;

    std::string path_;
    std::ifstream in_;
    Data data_ = Data::Ascii;
    std::size_t size_ = 0, done_ = 0, row_bytes_ = 0;
    std::vector<std::string> names_;
    std::vector<Column> columns_;
    std::vector<char> bytes_;  // of one point; of all, field by field, where they were compressed
    std::string line_;
};
}  // namespace taut
