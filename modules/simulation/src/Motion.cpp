#include "taut/simulation/Motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace taut::simulation
{
namespace
{
constexpr int kDegree = Motion::kDegree;
using Basis = std::array<double, kDegree + 1>;

/** Weights of the control points at fraction u of a segment, from those of one degree less:
 * w_p[j] = ((u + p - j) w_{p-1}[j-1] + (1 - u + j) w_{p-1}[j]) / p. */
Basis raised(const Basis& lower, int p, double u)
{
    Basis w{};
    for (int j = 0; j <= p; j++)
        w[j] =
            ((u + p - j) * (j > 0 ? lower[j - 1] : 0) + (1 - u + j) * (j < p ? lower[j] : 0)) / p;
    return w;
}

/** Derivative by u of the weights of degree p + 1 from those of degree p: a difference. */
Basis differenced(const Basis& w, int p)
{
    Basis d{};
    for (int j = 0; j <= p + 1; j++) d[j] = (j > 0 ? w[j - 1] : 0) - (j <= p ? w[j] : 0);
    return d;
}

Basis basis(int degree, double u)
{
    Basis w{1};
    for (int p = 1; p <= degree; p++) w = raised(w, p, u);
    return w;
}

Eigen::Quaterniond quaternionOf(const Eigen::Matrix<double, 7, 1>& c)
{
    return Eigen::Quaterniond(c[6], c[3], c[4], c[5]);
}
}  // namespace

Motion::Motion(const std::vector<Pose>& controls, double spacing) : spacing_(spacing)
{
    if (controls.size() <= kDegree || !(spacing > 0))
        throw std::invalid_argument("a motion needs at least 6 control poses and a spacing > 0");
    controls_.reserve(controls.size());
    for (const Pose& pose : controls)
    {
        Eigen::Vector4d q = Eigen::Quaterniond(pose.R).coeffs();
        if (!controls_.empty() && q.dot(controls_.back().tail<4>()) < 0) q = -q;
        Control c;
        c << pose.p, q;
        if (!c.allFinite()) throw std::invalid_argument("a control pose of a motion is not finite");
        controls_.push_back(c);
    }
}

std::size_t Motion::controlsFor(double duration, double spacing)
{
    return static_cast<std::size_t>(std::ceil(duration / spacing)) + kDegree + 1;
}

double Motion::duration() const
{
    return spacing_ * static_cast<double>(controls_.size() - kDegree);
}

std::size_t Motion::segmentOf(double t, double& fraction) const
{
    const double x = std::max(0.0, t / spacing_);
    const std::size_t last = controls_.size() - kDegree - 1;
    const std::size_t i = std::min(last, static_cast<std::size_t>(x));
    fraction = std::min(1.0, x - static_cast<double>(i));
    return i;
}

Pose Motion::poseAt(double t) const
{
    double u = 0;
    const std::size_t i = segmentOf(t, u);
    const Basis w = basis(kDegree, u);
    Control c = Control::Zero();
    for (int j = 0; j <= kDegree; j++) c += w[j] * controls_[i + j];
    return {quaternionOf(c).normalized().toRotationMatrix(), c.head<3>()};
}

MotionState Motion::at(double t) const
{
    double u = 0;
    const std::size_t i = segmentOf(t, u);
    const Basis w3 = basis(kDegree - 2, u);
    const Basis w4 = raised(w3, kDegree - 1, u);
    const Basis w5 = raised(w4, kDegree, u);
    const Basis d5 = differenced(w4, kDegree - 1);
    const Basis dd5 = differenced(differenced(w3, kDegree - 2), kDegree - 1);

    Control c = Control::Zero(), dc = Control::Zero(), ddc = Control::Zero();
    for (int j = 0; j <= kDegree; j++)
    {
        c += w5[j] * controls_[i + j];
        dc += d5[j] / spacing_ * controls_[i + j];
        ddc += dd5[j] / (spacing_ * spacing_) * controls_[i + j];
    }

    // The quaternion q is not of unit length; its direction is the rotation. With n = q.q:
    // rate = 2 vec(q* q') / n, its derivative = (2 vec(q* q'') - 2 (q.q') rate) / n.
    const Eigen::Quaterniond q = quaternionOf(c);
    const double n = q.squaredNorm();
    MotionState s;
    s.T_world_imu = {q.normalized().toRotationMatrix(), c.head<3>()};
    s.v_world = dc.head<3>();
    s.a_world = ddc.head<3>();
    s.rate = 2 / n * (q.conjugate() * quaternionOf(dc)).vec();
    s.angular_acceleration = (2 * (q.conjugate() * quaternionOf(ddc)).vec() -
                              2 * c.tail<4>().dot(dc.tail<4>()) * s.rate) /
                             n;
    return s;
}
}  // namespace taut::simulation
