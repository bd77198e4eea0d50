#include "taut/slam/ClosureGate.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace taut
{
namespace
{
/** The standard normal deviate exceeded with that probability, by bisection. */
double normalBeyond(double share)
{
    double low = -10, high = 10;
    for (int i = 0; i < 60; i++)
    {
        const double middle = (low + high) / 2;
        (0.5 * std::erfc(middle / std::sqrt(2.0)) > share ? low : high) = middle;
    }
    return low;
}
}  // namespace

double chiSquareBeyond(double share_beyond, int degrees)
{
    const double spread = 2.0 / (9.0 * degrees);
    const double root = 1 - spread + normalBeyond(share_beyond) * std::sqrt(spread);
    return degrees * root * root * root;
}

bool GapTest::isWithin(double share_beyond) const
{
    return directions > 0 && chi2 <= chiSquareBeyond(share_beyond, directions);
}

GapTest testGap(const Vector6d& gap, const Matrix6d& covariance, const Matrix6d& information)
{
    const ShownDirections shown = shownDirections(information);
    GapTest test;
    test.directions = static_cast<int>(shown.information.size());
    if (test.directions == 0) return test;
    const Eigen::VectorXd seen = shown.basis.transpose() * gap;
    Eigen::MatrixXd of_gap = shown.basis.transpose() * covariance * shown.basis;
    of_gap.diagonal() += shown.information.cwiseInverse();
    test.chi2 = seen.dot(of_gap.ldlt().solve(seen));
    return test;
}
}  // namespace taut
