#pragma once

#include <cmath>
#include <cstdint>

/** \file Time.h
 * Time is an integer number of nanoseconds since the UNIX epoch: differences of stamps are exact,
 * and a day of recording loses no resolution, as doubles of seconds would. */
namespace taut
{
using Time = std::int64_t;      //!< nanoseconds since the UNIX epoch
using Duration = std::int64_t;  //!< nanoseconds

constexpr double toSeconds(Duration d)
{
    return static_cast<double>(d) * 1e-9;
}
inline Duration fromSeconds(double s)
{
    return static_cast<Duration>(std::llround(s * 1e9));
}
}  // namespace taut
