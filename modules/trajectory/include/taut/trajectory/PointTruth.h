#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "taut/core/Time.h"

/** \file PointTruth.h
 * Undistorted points in a file, so that undistortion itself can be scored: the simulator writes
 * where every point truly was, the estimator where it takes it to be. Binary, little endian:
 *
 *     char[8] "TAUTPNTS", uint32 version = 1
 *     per scan: int64 stamp [ns], uint32 count, count x 3 float32 [m]
 *
 * `stamp` is Scan::end as the rawlog module gives it: the time of the IMU frame that the positions
 * are in. The positions stand in the order of the points of the observation in the rawlog, one for
 * each of them that is finite and a return; those that were dropped later (too near...) are NaN. */
namespace taut
{
struct UndistortedScan
{
    Time stamp = 0;                          //!< Scan::end
    std::vector<Eigen::Vector3f> positions;  //!< [m], IMU frame at `stamp`; NaN where dropped
};

/** Writes scan by scan. Throws std::runtime_error if the file cannot be written, and
 * std::invalid_argument if the stamps do not increase. */
class PointTruthWriter
{
 public:
    explicit PointTruthWriter(const std::string& path);
    void write(const UndistortedScan& scan);
    /** Tells of a full disk, which the destructor cannot. */
    void close();

 private:
    std::string path_;
    std::ofstream file_;
    std::size_t scans_ = 0;
    Time last_ = 0;
};

/** Reads scan by scan. Throws std::runtime_error with file and scan number for a file of another
 * kind or version, one that is cut short, or stamps that do not increase. */
class PointTruthReader
{
 public:
    explicit PointTruthReader(const std::string& path);
    /** False at the end of the file. */
    bool next(UndistortedScan& scan);

 private:
    [[noreturn]] void fail(const std::string& what) const;

    std::string path_;
    std::ifstream file_;
    std::size_t scans_ = 0;
    Time last_ = 0;
};

/** How far undistorted points are from their truth. */
struct PointScores
{
    std::size_t scans = 0;               //!< in both files
    std::size_t truth_scans = 0;         //!< in the truth
    std::size_t points = 0;              //!< scored: finite in both
    std::size_t missing = 0;             //!< dropped by the estimate, known to the truth
    double rmse = 0, mean = 0, max = 0;  //!< over points [m]
    double median_scan = 0;              //!< median over scans of the RMSE of a scan [m]
    double worst_scan = 0;               //!< largest RMSE of a scan [m]
    Time worst_stamp = 0;                //!< and its stamp
};

/** Compares the scans whose stamps agree to 1 us (rawlogs keep 100 ns). Throws ScoreRefused if
 * these are none, or less than the share `min_coverage` of the scans of the truth, or if they hold
 * less than that share of its points, and std::runtime_error if two such scans differ in their
 * number of points. Scans before `from` are left out. */
PointScores scorePoints(
    const std::string& truth_path, const std::string& estimate_path, double min_coverage = 0.5,
    Time from = 0);
}  // namespace taut
