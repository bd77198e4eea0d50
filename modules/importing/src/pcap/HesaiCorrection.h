#pragma once

#include <string>

#include "taut/packets/hesai/Correction.h"

namespace taut
{
struct HesaiAngles
{
    hesai::Calibration calibration;
    std::string path;  //!< of the correction file; empty: the data sheet's
};

/** The angles of a sensor in a recording (a file or a folder): of the correction file that is
 * `given`, else of the recording's name with .csv, else of the one correction file in its folder
 * that fits the sensor, else the data sheet's. Throws hesai::CorrectionError naming the file if
 * what is there cannot be read, is not of such a sensor or is ambiguous. */
HesaiAngles findHesaiAngles(
    const std::string& recording, const std::string& given, hesai::Model model);
}  // namespace taut
