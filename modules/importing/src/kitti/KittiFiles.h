#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/Imu.h"
#include "taut/core/Scan.h"
#include "taut/core/Warning.h"

/** \file KittiFiles.h
 * The files of the KITTI data sets. Sources: readme.txt and dataformat.txt of the development kit
 * of the raw data; documentation of KITTI-360. All throw std::runtime_error naming the file. */
namespace taut::kitti
{
/** Times "2011-09-26 13:02:25.951199337", one a line, taken as UTC; an empty line is no time. */
std::vector<std::optional<Time>> readTimestamps(const std::filesystem::path& file);

/** Times in seconds, one a line. */
std::vector<Time> readTimes(const std::filesystem::path& file);

/** Lines "key: numbers" of a calibration file. */
std::map<std::string, std::vector<double>> readCalibration(const std::filesystem::path& file);

/** The number that a file's name is: 0000000042.bin. */
std::optional<std::size_t> frameOf(const std::filesystem::path& file);

/** The points of a scan, x y z reflectance: as floats (.bin) or text (.txt). `offset_of` gives the
 * time of a point since `stamp` [ns]. Reflectances of 0 to 1 become 0 to 255. */
Scan readPoints(
    const std::filesystem::path& file, Time stamp,
    const std::function<Duration(double x, double y)>& offset_of);

/** The share of a sweep that had passed at a point: the scanner turns clockwise, seen from above,
 * and begins at its back. 0 to 1. */
double shareOfSweep(double x, double y);

/** The samples of an oxts folder (data/, timestamps.txt) one by one. */
class OxtsReader
{
 public:
    OxtsReader(const std::filesystem::path& folder, WarningSink warn);

    /** Files that cannot be used are reported ("imu_invalid"). */
    std::optional<ImuSample> next();

    const std::filesystem::path& folder() const { return folder_; }
    std::size_t size() const { return files_.size(); }

 private:
    std::filesystem::path folder_;
    WarningSink warn_;
    std::vector<std::filesystem::path> files_;
    std::vector<std::optional<Time>> times_;
    std::size_t next_ = 0;
};
}  // namespace taut::kitti
