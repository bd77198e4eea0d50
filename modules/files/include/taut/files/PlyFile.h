#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

/** \file PlyFile.h
 * Point clouds in PLY files: "The PLY Polygon File Format", G. Turk, 1994. */
namespace taut
{
/** Reads the vertices of a PLY file one by one, so that a file larger than memory can be used.
 * Formats: ascii and binary_little_endian, with number properties of any type. Elements after the
 * vertices are left alone. */
class PlyReader
{
 public:
    /** Opens the file and reads its header. Throws std::runtime_error that names the file and the
     * cause: not there, not a PLY file, a format or property that cannot be read, fewer or more
     * data than the header says (which a program leaves behind that was killed while writing). */
    explicit PlyReader(const std::string& path);

    /** Number of vertices. */
    std::size_t size() const { return size_; }

    /** Names of the properties, in the order of the columns. */
    const std::vector<std::string>& columns() const { return names_; }

    /** Column of that property; -1 if there is none. */
    int column(const std::string& name) const;

    /** The next vertex: one value a column. False after the last one. Throws std::runtime_error
     * with the number of the vertex where the data end early or are not numbers. */
    bool next(std::vector<double>& row);

 private:
    enum class Type
    {
        Int8,
        UInt8,
        Int16,
        UInt16,
        Int32,
        UInt32,
        Float32,
        Float64
    };

    void readHeader();
    void readProperty(const std::string& line);
    void checkLength();
    void nextAscii(std::vector<double>& row);
    void nextBinary(std::vector<double>& row);
    static double decode(Type type, const char* bytes);
    static std::size_t sizeOf(Type type);
    [[noreturn]] void fail(const std::string& cause) const;
    [[noreturn]] void failTooLong() const;

    std::string path_;
    std::ifstream in_;
    bool ascii_ = false;
    bool more_elements_ = false;  //!< something follows the vertices
    std::size_t size_ = 0, done_ = 0;
    std::size_t row_bytes_ = 0;
    std::vector<std::string> names_;
    std::vector<Type> types_;
    std::vector<char> buffer_;         //!< whole rows, binary
    std::size_t buffer_position_ = 0;  //!< bytes of it used
    std::string line_;
};

/** One point of a map. */
struct PlyPoint
{
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  //!< [m]
    float intensity = 0;                                 //!< 0 where the file has none
};

/** All points of a PLY file with x, y, z and, if there, intensity. Throws as PlyReader does, and
 * where x, y or z are missing. */
std::vector<PlyPoint> readPlyPoints(const std::string& path);

/** Writes points (x, y, z, intensity as floats) to a binary PLY file as they come: the cloud may be
 * larger than memory. After each flush() the file is whole: its header states the points in it. */
class PlyPointWriter
{
 public:
    /** Creates or empties the file. Throws std::runtime_error if that fails. */
    explicit PlyPointWriter(std::string path);
    /** Closes the file; an error goes unnoticed: call close(). */
    ~PlyPointWriter();
    PlyPointWriter(const PlyPointWriter&) = delete;
    PlyPointWriter& operator=(const PlyPointWriter&) = delete;

    /** Throws std::runtime_error on a point that is not finite, after close(), and when writing
     * fails. */
    void append(const PlyPoint& point);

    /** Number of points so far. */
    std::size_t size() const { return size_; }

    /** Writes what is held back and the number of points. Throws std::runtime_error, with the
     * cause, when writing fails; the file is closed then, as the flush before left it. */
    void flush();

    /** As flush(); nothing can be added any more. */
    void close();

 private:
    [[noreturn]] void fail();

    std::string path_;
    std::ofstream out_;
    std::string rows_;                  //!< not yet in the file
    std::size_t size_ = 0, whole_ = 0;  //!< whole_: at the last flush
};
}  // namespace taut
