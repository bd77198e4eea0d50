#include "taut/odometry/weakDirections.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace taut
{
namespace
{
/** What the planes know of the three directions: sum n n^T / sigma^2. */
Matrix3d translationInformation(const std::vector<Correspondence>& correspondences)
{
    Matrix3d sum = Matrix3d::Zero();
    for (const Correspondence& c : correspondences)
        if (c.surface == Surface::Plane)
            sum += c.direction * c.direction.transpose() / square(c.sigma);
    return sum;
}

/** The plane through the query's foot on c, with another normal. */
Correspondence turned(const Correspondence& c, const Vector3d& query, const Vector3d& normal)
{
    Correspondence t = c;
    t.point = query - c.direction * c.direction.dot(query - c.point);
    t.direction = normal;
    return t;
}
}  // namespace

void removeNormalErrors(
    const std::vector<MapPoint>& queries, double normal_error,
    std::vector<Correspondence>& correspondences)
{
    const Matrix3d principal =
        Eigen::SelfAdjointEigenSolver<Matrix3d>(translationInformation(correspondences))
            .eigenvectors();
    const double least = std::sin(normal_error);
    for (std::size_t i = 0; i < correspondences.size(); i++)
    {
        Correspondence& c = correspondences[i];
        if (c.surface != Surface::Plane) continue;
        Vector3d facing = principal.transpose() * c.direction;
        for (int k = 0; k < 3; k++)
            if (std::abs(facing[k]) < least) facing[k] = 0;
        c = turned(c, queries[i].position, (principal * facing).normalized());
    }
}
}  // namespace taut
