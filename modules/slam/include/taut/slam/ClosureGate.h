#pragma once

#include "taut/core/LoopClosure.h"

namespace taut
{
/** A gap and how likely it is. */
struct GapTest
{
    double chi2 = 0;
    int directions = 0;  //!< degrees of freedom
    /** Within what happens in all but so small a share of cases. */
    bool isWithin(double share_beyond) const;
};

/** The gap d of T_from_to Exp(d), of that covariance, in the directions in which the information of
 * a loop is not zero. */
GapTest testGap(const Vector6d& gap, const Matrix6d& covariance, const Matrix6d& information);

/** The value that chi-square of so many degrees of freedom exceeds with that probability (Wilson
 * and Hilferty, 1931: within 3 % for one degree, 1 % for more). */
double chiSquareBeyond(double share_beyond, int degrees);
}  // namespace taut
