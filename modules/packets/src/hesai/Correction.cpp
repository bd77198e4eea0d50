#include "taut/packets/hesai/Correction.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace taut::hesai
{
namespace
{
constexpr double kDegree = M_PI / 180, kTolerance = 3 * kDegree;
constexpr std::size_t kMostLasers = 256, kMostBytes = 256 * 1024;

bool isHeading(std::string line)
{
    std::transform(
        line.begin(), line.end(), line.begin(),
        [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return line.find("elevation") != std::string::npos && line.find("azimuth") != std::string::npos;
}

/** A number that fills the text but for blanks. */
double number(const std::string& text)
{
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool rest = std::any_of(
        static_cast<const char*>(end), text.c_str() + text.size(),
        [](unsigned char c) { return std::isspace(c) == 0; });
    if (end == text.c_str() || rest || !std::isfinite(value))
        throw CorrectionError("'" + text + "' is no number");
    return value;
}

/** A line of three numbers, to its place. */
void addLine(const std::string& line, Calibration& calibration, std::vector<bool>& known)
{
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    if (cells.size() < 3) throw CorrectionError("the line '" + line + "' is cut short");
    const double channel = number(cells[0]), elevation = number(cells[1]);
    const double azimuth = number(cells[2]);
    if (channel < 1 || channel > kMostLasers || channel != std::floor(channel))
        throw CorrectionError("channel '" + cells[0] + "' is none");
    if (std::abs(elevation) > 90 || std::abs(azimuth) > 180)
        throw CorrectionError("the line '" + line + "' has an angle that is none");
    const auto laser = static_cast<std::size_t>(channel) - 1;
    if (laser >= calibration.size())
    {
        calibration.resize(laser + 1);
        known.resize(laser + 1);
    }
    if (known[laser]) throw CorrectionError("channel " + cells[0] + " is there twice");
    known[laser] = true;
    calibration[laser] = {elevation * kDegree, azimuth * kDegree};
}

void checkAngle(double angle, double expected, std::size_t laser, const char* what, Model model)
{
    if (std::abs(angle - expected) <= kTolerance) return;
    throw CorrectionError(
        std::string("it is of another sensor: the ") + what + " of channel " +
        std::to_string(laser + 1) + " is " + std::to_string(angle / kDegree) +
        " degrees, that of a " + nameOf(model) + " " + std::to_string(expected / kDegree));
}
}  // namespace

Calibration parseCorrection(const std::string& text)
{
    Calibration calibration;
    std::vector<bool> known;
    std::istringstream in(text);
    bool begun = false;
    for (std::string line; std::getline(in, line);)
    {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (begun && line.find(',') != std::string::npos) addLine(line, calibration, known);
        begun = begun || isHeading(line);
    }
    if (!begun) throw CorrectionError("it has no line that names channel, elevation and azimuth");
    if (known.empty()) throw CorrectionError("it has no angles");
    const auto missing = std::find(known.begin(), known.end(), false);
    if (missing != known.end())
        throw CorrectionError(
            "channel " + std::to_string(missing - known.begin() + 1) + " is missing");
    return calibration;
}

Calibration loadCorrection(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    std::string text(kMostBytes + 1, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    if (text.empty()) throw CorrectionError("cannot read '" + path + "'");
    try
    {
        if (text.size() > kMostBytes) throw CorrectionError("it is too long");
        return parseCorrection(text);
    }
    catch (const CorrectionError& e)
    {
        throw CorrectionError("'" + path + "' is no correction file of a Hesai: " + e.what());
    }
}

void checkCorrection(const Calibration& calibration, Model model)
{
    const Calibration& expected = defaultCalibration(model);
    if (calibration.size() != expected.size())
        throw CorrectionError(
            "it is of another sensor: it has " + std::to_string(calibration.size()) +
            " lasers, a " + nameOf(model) + " has " + std::to_string(expected.size()));
    for (std::size_t i = 0; i < expected.size(); i++)
    {
        checkAngle(calibration[i].elevation, expected[i].elevation, i, "elevation", model);
        checkAngle(calibration[i].azimuth, expected[i].azimuth, i, "azimuth", model);
    }
}
}  // namespace taut::hesai
