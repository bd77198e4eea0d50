#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "taut/report/Report.h"

namespace taut
{
std::string base64(const std::string& bytes);

/** Characters of so many bytes in base64. */
constexpr std::size_t base64Size(std::size_t bytes)
{
    return (bytes + 2) / 3 * 4;
}

/** Appends the bytes of a number: little-endian, as all of taut's files. */
template <class Number>
void appendBytes(std::string& bytes, const Number& value)
{
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(Number));
}

/** Points in few bytes: coordinates in 16 bits of the box around them, intensities in 8. */
struct PackedPoints
{
    Eigen::Vector3d min = Eigen::Vector3d::Zero(), size = Eigen::Vector3d::Zero();  //!< [m]
    float max_intensity = 0;  //!< told by 255; 0: no point has one, and `intensities` is empty
    std::size_t count = 0;
    std::string positions, intensities;
};

/** Packs at most `max_count` of the finite points, evenly thinned, in an order whose every
 * beginning is an even sample of all: a page may draw fewer. The brightest hundredth has one
 * intensity. */
PackedPoints pack(const std::vector<ReportPoint>& points, std::size_t max_count);
}  // namespace taut
