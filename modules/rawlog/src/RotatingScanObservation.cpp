#include <mrpt/obs/CObservationRotatingScan.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "MrptConversion.h"
#include "ObservationToScan.h"
#include "taut/packets/velodyne/Decoder.h"

namespace taut
{
using mrpt::obs::CObservationRotatingScan;

namespace
{
constexpr double kLongestSweep = 3600;  // [s]; far above what the times of points can be
constexpr char kVlp16[] = "VLP-16", kHdl32[] = "HDL-32E";  // as MRPT names them

void check(const CObservationRotatingScan& scan)
{
    const auto fits = [&scan](const auto& image)
    { return image.rows() == scan.rowCount && image.cols() == scan.columnCount; };
    if (scan.columnCount == 0 || !fits(scan.rangeImage))
        throw std::runtime_error("its range image is not of the size that it states");
    if (!scan.intensityImage.empty() && !fits(scan.intensityImage))
        throw std::runtime_error("its intensity image is not of the size that it states");
    const double numbers[] = {
        scan.rangeResolution, scan.startAzimuth, scan.azimuthSpan, scan.sweepDuration};
    for (const double v : numbers)
        if (!std::isfinite(v)) throw std::runtime_error("its geometry is not finite");
    if (std::abs(scan.sweepDuration) > kLongestSweep)
        throw std::runtime_error("its sweep takes longer than an hour");
    // MRPT's fromVelodyne() counts columns a laser too often and azimuths clockwise, against the
    // meaning of these fields: a world made of it would be a mirror image.
    if ((scan.lidarModel == kVlp16 || scan.lidarModel == kHdl32) && scan.azimuthSpan > 0)
        throw std::runtime_error(
            "a " + scan.lidarModel +
            " cannot turn counter-clockwise: the range image was made by MRPT's fromVelodyne(), "
            "whose azimuths are wrong; record the raw packets");
}

// The observation does not hold the elevations of its rows.
std::vector<double> rowElevations(const CObservationRotatingScan& scan, const LidarRig& rig)
{
    const int rows = scan.rowCount;
    std::vector<double> elevations(static_cast<std::size_t>(rows));
    const auto take = [&elevations](const velodyne::Calibration& lasers)
    {
        if (lasers.size() != elevations.size())
            throw std::runtime_error("its number of rows is not that of its sensor");
        for (std::size_t i = 0; i < lasers.size(); i++) elevations[i] = lasers[i].elevation;
    };
    if (rig.row_elevations)
    {
        const auto [first, last] = *rig.row_elevations;
        for (int i = 0; i < rows; i++)
            elevations[i] = rows == 1 ? first : first + (last - first) * i / (rows - 1);
    }
    else if (scan.lidarModel == kVlp16)
        take(velodyne::defaultCalibration(velodyne::Model::Vlp16));
    else if (scan.lidarModel == kHdl32)
        take(velodyne::defaultCalibration(velodyne::Model::Hdl32));
    else if (rows > 1)
        throw std::runtime_error(
            "the elevations of the rows of '" + scan.lidarModel +
            "' are not known: give row_elevations in the rig file");
    return elevations;
}
}  // namespace

ScanBuilder rotatingScanToPoints(const CObservationRotatingScan& scan, const LidarRig& rig)
{
    check(scan);
    const auto elevations = rowElevations(scan, rig);
    const int columns = scan.columnCount;
    const bool full_turn = std::abs(scan.azimuthSpan) > 2 * M_PI * (1 - 0.5 / columns);
    const int steps = full_turn || columns == 1 ? columns : columns - 1;
    const Time stamp = toTime(scan.timestamp);
    ScanBuilder builder(stamp, static_cast<std::size_t>(scan.rangeImage.size()));
    builder.setRings(scan.rowCount > 1 ? scan.rowCount : 0);
    for (int column = 0; column < columns; column++)
    {
        const double share = static_cast<double>(column) / steps;
        const double azimuth = scan.startAzimuth + share * scan.azimuthSpan;
        const Time t = stamp + fromSeconds(share * scan.sweepDuration);
        for (int row = 0; row < scan.rowCount; row++)
        {
            const double range = scan.rangeImage(row, column) * scan.rangeResolution;
            const double e = elevations[row];
            const Eigen::Vector3d direction(
                std::cos(e) * std::cos(azimuth), std::cos(e) * std::sin(azimuth), std::sin(e));
            builder.add(
                (range * direction).cast<float>(),
                scan.intensityImage.empty() ? 0.0f : scan.intensityImage(row, column), t, row);
        }
    }
    return builder;
}
}  // namespace taut
