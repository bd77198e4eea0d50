#include "taut/core/PreintegratedImu.h"

#include <algorithm>

namespace taut
{
ImuSample interpolate(const ImuSample& a, const ImuSample& b, Time t)
{
    if (a.t == b.t) return a;
    const double s = static_cast<double>(t - a.t) / static_cast<double>(b.t - a.t);
    return {
        t, a.gyro + s * (b.gyro - a.gyro), a.accel + s * (b.accel - a.accel),
        std::max(a.gyro_hidden, b.gyro_hidden), std::max(a.accel_hidden, b.accel_hidden)};
}

Motion stepBackwardValue(
    const Motion& at_later, const ImuSample& later, const ImuSample& earlier,
    const Vector3d& bias_accel, const Vector3d& bias_gyro)
{
    const double dt = toSeconds(later.t - earlier.t);
    const Motion& L = at_later;
    const Vector3d rate = 0.5 * (later.gyro + earlier.gyro) - bias_gyro;
    Motion E;
    E.gamma = L.gamma * expSO3(-rate * dt);
    E.beta =
        L.beta -
        0.5 * dt * (L.gamma * (later.accel - bias_accel) + E.gamma * (earlier.accel - bias_accel));
    E.alpha = L.alpha - 0.5 * dt * (L.beta + E.beta);
    return E;
}

MotionDelta stepBackward(
    const MotionDelta& at_later, const ImuSample& later, const ImuSample& earlier,
    const Vector3d& bias_accel, const Vector3d& bias_gyro)
{
    const MotionDelta& L = at_later;
    MotionDelta E;
    static_cast<Motion&>(E) = stepBackwardValue(at_later, later, earlier, bias_accel, bias_gyro);
    const double dt = toSeconds(later.t - earlier.t);
    const Vector3d turned = -(0.5 * (later.gyro + earlier.gyro) - bias_gyro) * dt;

    // The same recursion, differentiated by the biases.
    E.dtheta_dbg = expSO3(-turned) * L.dtheta_dbg + rightJacobianSO3(turned) * dt;
    const Matrix3d turned_later = L.gamma * hat(later.accel - bias_accel);
    const Matrix3d turned_earlier = E.gamma * hat(earlier.accel - bias_accel);
    E.dbeta_dba = L.dbeta_dba + 0.5 * dt * (L.gamma + E.gamma);
    E.dbeta_dbg =
        L.dbeta_dbg + 0.5 * dt * (turned_later * L.dtheta_dbg + turned_earlier * E.dtheta_dbg);
    E.dalpha_dba = L.dalpha_dba - 0.5 * dt * (L.dbeta_dba + E.dbeta_dba);
    E.dalpha_dbg = L.dalpha_dbg - 0.5 * dt * (L.dbeta_dbg + E.dbeta_dbg);
    return E;
}

MotionDelta correctedForBias(
    const MotionDelta& delta, const Vector3d& dbias_accel, const Vector3d& dbias_gyro)
{
    MotionDelta c = delta;
    const Vector3d turn = delta.dtheta_dbg * dbias_gyro;
    c.gamma = delta.gamma * expSO3(turn);
    c.dtheta_dbg = rightJacobianSO3(turn) * delta.dtheta_dbg;  // there, not where it came from
    c.beta += delta.dbeta_dba * dbias_accel + delta.dbeta_dbg * dbias_gyro;
    c.alpha += delta.dalpha_dba * dbias_accel + delta.dalpha_dbg * dbias_gyro;
    return c;
}

PreintegratedImu PreintegratedImu::correctedForBias(
    const Vector3d& accel, const Vector3d& gyro) const
{
    PreintegratedImu c = *this;
    for (ImuKnot& knot : c.knots)
        knot.delta = taut::correctedForBias(knot.delta, accel - bias_accel, gyro - bias_gyro);
    c.bias_accel = accel;
    c.bias_gyro = gyro;
    return c;
}

std::size_t PreintegratedImu::intervalOf(Time t, std::size_t hint) const
{
    // Interval [knots[i+1], knots[i]] that holds t; the outermost ones reach on.
    const std::size_t last = knots.size() - 2;
    std::size_t i = hint < last ? hint : last;
    while (i > 0 && t > knots[i].sample.t) --i;
    while (i < last && t < knots[i + 1].sample.t) ++i;
    return i;
}

MotionDelta PreintegratedImu::at(Time t, std::size_t& hint) const
{
    const std::size_t i = hint = intervalOf(t, hint);
    if (t == knots[i].sample.t) return knots[i].delta;
    const ImuSample at_t = interpolate(knots[i + 1].sample, knots[i].sample, t);
    return stepBackward(knots[i].delta, knots[i].sample, at_t, bias_accel, bias_gyro);
}

double PreintegratedImu::gapShare(Time t, std::size_t hint) const
{
    const double of_time = toSeconds(end() - t) / duration();
    if (!(knots.back().hidden > 0)) return of_time;
    const std::size_t i = intervalOf(t, hint);
    const double within =
        toSeconds(knots[i].sample.t - t) / toSeconds(knots[i].sample.t - knots[i + 1].sample.t);
    const double hidden = knots[i].hidden + within * (knots[i + 1].hidden - knots[i].hidden);
    const double shown = covariance.diagonal().tail<3>().sum() - knots.back().hidden;
    return (of_time * shown + hidden) / (shown + knots.back().hidden);
}

MotionDelta PreintegratedImu::at(Time t) const
{
    std::size_t hint = 0;
    return at(t, hint);
}

Motion PreintegratedImu::valueAt(Time t, std::size_t& hint) const
{
    const std::size_t i = hint = intervalOf(t, hint);
    const ImuSample at_t = interpolate(knots[i + 1].sample, knots[i].sample, t);
    return stepBackwardValue(knots[i].delta, knots[i].sample, at_t, bias_accel, bias_gyro);
}
}  // namespace taut
