#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "taut/packets/hesai/Model.h"

namespace taut::hesai
{
/** Where one laser points. */
struct Laser
{
    double elevation = 0;  //!< [rad], up
    double azimuth = 0;    //!< [rad], clockwise; added to that of its block
};
using Calibration = std::vector<Laser>;  //!< by laser

/** The data sheet's angles: good to some tenths of a degree. */
const Calibration& defaultCalibration(Model model);

/** A correction file cannot be read, or not be of the sensor whose packets came; nothing decoded
 * with it can be believed. */
struct CorrectionError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/** From the text of a correction file: lines of channel, elevation and azimuth [deg] below a line
 * with those names; what stands before it and lines without commas are passed over. Throws
 * CorrectionError if channels are missing or doubled or an angle is none. */
Calibration parseCorrection(const std::string& text);

/** The same from a file of at most 256 kB, which is named in the message. */
Calibration loadCorrection(const std::string& path);

/** Throws CorrectionError if the angles are not those of such a sensor, within 3 degrees. */
void checkCorrection(const Calibration& calibration, Model model);
}  // namespace taut::hesai
