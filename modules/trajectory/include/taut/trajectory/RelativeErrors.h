#pragma once

#include <vector>

#include "taut/trajectory/Alignment.h"
#include "taut/trajectory/Statistics.h"

/** \file RelativeErrors.h
 * Errors of the motion between two poses: E = (T_true_i^-1 T_true_j)^-1 (T_est_i^-1 T_est_j). They
 * need no alignment, and tell drift apart from a single bad place. Distances are along the true
 * positions of the pairs: at the rate of the estimate, so that the noise of a dense truth does not
 * lengthen them. */
namespace taut
{
/** The error over a fixed time or distance (RPE; Sturm et al., IROS 2012). */
struct RelativeError
{
    double delta = 0;         //!< [s] or [m]
    Statistics translation;   //!< [m] over delta
    Statistics rotation_deg;  //!< [deg] over delta
};

/** From every pose to the one nearest to `seconds` later; none if that is off by more than 10 %, or
 * past the last pose. */
RelativeError relativeErrorOverTime(const PosePairs& pairs, double seconds);

/** From every pose to the one nearest to `metres` further; none if that is off by more than 10 %.
 */
RelativeError relativeErrorOverDistance(const PosePairs& pairs, double metres);

/** Mean error of all segments of one length, divided by the length. */
struct SegmentError
{
    double length = 0;  //!< [m]; 0 for the mean over all lengths
    std::size_t count = 0;
    double translation_percent = 0;  //!< [% of the length]
    double rotation_deg_per_m = 0;   //!< [deg/m]
};

struct SegmentErrors
{
    SegmentError all;  //!< mean over all segments, long and short alike
    std::vector<SegmentError> by_length;
};

/** The KITTI odometry score (Geiger et al., CVPR 2012), as its development kit computes it:
 * segments start at every `step`-th pose and end at the first pose that is further than the length.
 */
SegmentErrors segmentErrors(
    const PosePairs& pairs, const std::vector<double>& lengths, std::size_t step);

/** The lengths and the step of KITTI: 100, 200 .. 800 m from every tenth pose. */
SegmentErrors kittiSegmentErrors(const PosePairs& pairs);

/** The same for short logs: 5, 10 .. 40 m from every pose. */
SegmentErrors shortSegmentErrors(const PosePairs& pairs);
}  // namespace taut
