#include "taut/preintegration/MidpointPreintegrator.h"

#include <algorithm>
#include <stdexcept>

#include "chain.h"

IMPLEMENTS_MRPT_OBJECT(MidpointPreintegrator, taut::Preintegrator, taut)

namespace taut
{
namespace
{
using Iterator = ImuSamples::const_iterator;

bool isBefore(const ImuSample& s, Time t)
{
    return s.t < t;
}

/** The sample at time t: interpolated, or the nearest one held beyond the ends. */
ImuSample sampleAt(const ImuSamples& samples, Time t)
{
    const Iterator after = std::lower_bound(samples.begin(), samples.end(), t, isBefore);
    ImuSample s;
    if (after == samples.end())
        s = samples.back();
    else if (after == samples.begin() || after->t == t)
        s = *after;
    else
        s = interpolate(*(after - 1), *after, t);
    s.t = t;
    return s;
}

StepNoise noiseOf(
    const ImuSample& later, const ImuSample& earlier, const PreintegrationRequest& request,
    const MidpointConfig& config)
{
    const double sweep = toSeconds(request.end - request.begin);
    const double dt = toSeconds(later.t - earlier.t);
    const double gyro_scale = config.gyro_scale_error * later.gyro.norm();
    const double accel_scale = config.accel_scale_error * later.accel.norm();
    // An error that is constant over a sweep has, over the sweep, the variance of white noise of
    // density sigma sqrt(sweep); likewise over a gap.
    double gyro2 = request.noise.gyro * request.noise.gyro + gyro_scale * gyro_scale * sweep;
    double accel2 = request.noise.accel * request.noise.accel + accel_scale * accel_scale * sweep;
    // What a reading at the limit hides is taken as an error of that kind, too.
    const double gyro_hidden = std::max(later.gyro_hidden, earlier.gyro_hidden) * std::sqrt(sweep);
    const double accel_hidden =
        std::max(later.accel_hidden, earlier.accel_hidden) * std::sqrt(sweep);
    gyro2 += gyro_hidden * gyro_hidden;
    accel2 += accel_hidden * accel_hidden;
    if (dt > config.gap)
    {
        // A smooth signal leaves the straight line between its ends with the square of time; one
        // that wanders (a Brownian bridge) by the root of a twelfth of its change.
        const double smooth = square(std::min(1.0, dt / config.gap_time));
        const auto unknown = [&](double most, const Vector3d& change)
        { return std::sqrt(square(most * smooth) + change.squaredNorm() / 12); };
        const double rate = unknown(config.gap_rate, later.gyro - earlier.gyro);
        const double accel = unknown(config.gap_accel, later.accel - earlier.accel);
        gyro2 += rate * rate * dt;
        accel2 += accel * accel * dt;
    }
    return {std::sqrt(gyro2), std::sqrt(accel2), gyro_hidden};
}
}  // namespace

void MidpointPreintegrator::configure(ConfigSection& section)
{
    section.key("gap", config.gap, kPositive, "s, a longer interval between samples is a gap");
    section.key("gap_rate", config.gap_rate, kNotNegative, "rad/s, unknown rate in a long gap");
    section.key("gap_accel", config.gap_accel, kNotNegative, "m/s^2, the same of acceleration");
    section.key("gap_time", config.gap_time, kPositive, "s, from which a gap is long");
    section.key(
        "gyro_scale_error", config.gyro_scale_error, kNotNegative, "share of the measured rate");
    section.key(
        "accel_scale_error", config.accel_scale_error, kNotNegative, "share of the specific force");
}

PreintegratedImu MidpointPreintegrator::integrate(const PreintegrationRequest& request) const
{
    if (request.end <= request.begin)
        throw std::invalid_argument("preintegration over an interval that is empty or backward");
    if (!request.samples || request.samples->empty())
        throw std::invalid_argument("preintegration without any IMU sample");
    const ImuSamples& samples = *request.samples;

    PreintegratedImu chain = startChain(
        sampleAt(samples, request.end), request.previous.bias_accel, request.previous.bias_gyro);
    const auto add = [&](const ImuSample& earlier) {
        extendBackward(
            chain, earlier, noiseOf(chain.knots.back().sample, earlier, request, config));
    };

    Iterator it = std::lower_bound(samples.begin(), samples.end(), request.end, isBefore);
    while (it != samples.begin() && (it - 1)->t > request.begin) add(*--it);
    add(sampleAt(samples, request.begin));

    const double duration = chain.duration();
    const auto diagonal = [&](double walk) -> Matrix3d
    { return Matrix3d::Identity() * (walk * walk * duration); };
    chain.bias_walk_covariance.topLeftCorner<3, 3>() = diagonal(request.noise.accel_bias_walk);
    chain.bias_walk_covariance.bottomRightCorner<3, 3>() = diagonal(request.noise.gyro_bias_walk);
    return chain;
}
}  // namespace taut
