#pragma once

/** \file gaps.h
 * What counts as a gap in a stream. The preintegration has a finer one of its own for its noise
 * (preintegration.gap): there it costs nothing to be careful. */
namespace taut
{
/** [s] without an IMU sample that is worth a warning; as long a sample may be held. */
constexpr double kImuGap = 0.1;
/** [s] without an IMU sample after which its integral is one guess of several. */
constexpr double kLongImuGap = 0.3;
/** [s] without a scan that is worth a warning. */
constexpr double kLidarGap = 0.5;
}  // namespace taut
