#include "taut/core/Triangle.h"

#include <algorithm>

namespace taut
{
Vector3d nearestOnTriangle(
    const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c)
{
    const auto onSegment = [&p](const Vector3d& s, const Vector3d& e) -> Vector3d
    {
        const double length2 = (e - s).squaredNorm();
        const double k = length2 > 0 ? (p - s).dot(e - s) / length2 : 0;
        return s + std::clamp(k, 0.0, 1.0) * (e - s);
    };
    const Vector3d n = (b - a).cross(c - a);
    const bool inside = n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                        n.dot((a - c).cross(p - c)) >= 0 && n.squaredNorm() > 0;
    if (inside) return p - n * (n.dot(p - a) / n.squaredNorm());
    Vector3d best = onSegment(a, b);
    for (const Vector3d& q : {onSegment(b, c), onSegment(c, a)})
        if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
    return best;
}
}  // namespace taut
