#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <string>

/** \file LasFile.h
 * Point clouds in LAS files: "LAS Specification Version 1.2", American Society for Photogrammetry
 * and Remote Sensing, 2008. */
namespace taut
{
/** One point of a map. */
struct LasPoint
{
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  //!< [m]
    float intensity = 0;                                 //!< 0 to 255; beyond it is cut
    std::int64_t t = 0;                                  //!< [ns] since the UNIX epoch, UTC
};

/** Writes points to a LAS file of version 1.2 as they come: the cloud may be larger than memory.
 * Point format 1, which has a time. After each flush() the file is whole: its header states the
 * points in it, and their bounds.
 *
 * Coordinates are in steps of 1 mm from the origin of the cloud (scale 0.001, offset 0).
 * Intensities are stretched to 16 bit, as the format wants it: 255 is 65535.
 *
 * Times are adjusted standard GPS time, seconds since 1980-01-06 less 10^9, and the header says so.
 * Where the first point has no time since the UNIX epoch (before the year 2000: a clock that counts
 * from its start), they are seconds as they are, and the header does not say so. The header has no
 * date: the same points give the same bytes. */
class LasPointWriter
{
 public:
    /** Creates or empties the file. Throws std::runtime_error if that fails. */
    explicit LasPointWriter(std::string path);
    /** Closes the file; an error goes unnoticed: call close(). */
    ~LasPointWriter();
    LasPointWriter(const LasPointWriter&) = delete;
    LasPointWriter& operator=(const LasPointWriter&) = delete;

    /** Whether the format can hold this position: within 2147 km of the origin along each axis. */
    static bool fits(const Eigen::Vector3f& position);

    /** False: the point is left out, since it does not fit or the file holds 2^32 - 1 points, the
     * most of the format. Throws std::runtime_error on a point that is not finite, after close(),
     * and when writing fails. */
    bool append(const LasPoint& point);

    /** Number of points so far. */
    std::size_t size() const { return size_; }

    /** Writes what is held back, the number of points and their bounds. Throws std::runtime_error,
     * with the cause, when writing fails; the file is closed then, as the flush before left it. */
    void flush();

    /** As flush(); nothing can be added any more. */
    void close();

    /** Takes the points from a closed file of this writer for which `keep` of their number is
     * false. Throws std::runtime_error if the file cannot be read or written. */
    static void filter(const std::string& path, const std::function<bool(std::size_t)>& keep);

 private:
    void appendRow(const char* row);
    std::string header() const;
    double timeOf(std::int64_t t) const;
    [[noreturn]] void fail();

    std::string path_;
    std::ofstream out_;
    std::string rows_;                  //!< not yet in the file
    std::size_t size_ = 0, whole_ = 0;  //!< whole_: at the last flush
    bool is_gps_time_ = false;
    std::array<std::int32_t, 3> min_{}, max_{};  //!< [mm]
};
}  // namespace taut
