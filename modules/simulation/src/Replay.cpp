#include "taut/simulation/Replay.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace taut::simulation
{
namespace
{
constexpr double kRamp = 2.0;    // from rest to the recording's own pace [s]
constexpr double kMaxGap = 0.5;  // between poses [s]
constexpr double kReach = 3;     // of the kernel, in standard deviations

/** Time in the recording at time `since` after the rest: its pace grows from 0 to 1 over the ramp.
 */
double easedTime(double since)
{
    if (since <= 0) return 0;
    if (since >= kRamp) return since - kRamp / 2;
    const double x = since / kRamp;  // the pace is x^2 (3 - 2 x)
    return kRamp * x * x * x * (1 - x / 2);
}

void check(const std::vector<RecordedPose>& recording, const ReplayConfig& config)
{
    if (recording.size() < 2)
        throw std::runtime_error("the trajectory to replay '" + config.file + "' has no two poses");
    const double max_gap = std::max(kMaxGap, config.smoothing);
    for (std::size_t i = 1; i < recording.size(); i++)
    {
        const double gap = toSeconds(recording[i].t - recording[i - 1].t);
        if (gap > 0 && gap <= max_gap) continue;
        std::ostringstream s;
        s << "the trajectory to replay '" << config.file << "' "
          << (gap > 0 ? "has a gap" : "goes back in time") << " at "
          << toSeconds(recording[i].t - recording.front().t) << " s from its start";
        throw std::runtime_error(s.str());
    }
}

/** Mean of the poses around time t, weighted by a Gaussian; where none is near, the neighbours
 * count. */
Pose smoothPose(const std::vector<RecordedPose>& recording, double t, double sigma)
{
    const Time at = recording.front().t + fromSeconds(t), reach = fromSeconds(kReach * sigma);
    const auto earlier = [](const RecordedPose& p, Time time) { return p.t < time; };
    auto begin = std::lower_bound(recording.begin(), recording.end(), at - reach, earlier);
    auto end = std::lower_bound(recording.begin(), recording.end(), at + reach + 1, earlier);
    if (begin != recording.begin()) --begin;
    if (end != recording.end()) ++end;

    const Eigen::Quaterniond reference(begin->pose.R);
    Vector3d p = Vector3d::Zero();
    Eigen::Vector4d q = Eigen::Vector4d::Zero();
    double sum = 0;
    for (auto it = begin; it != end; ++it)
    {
        const double d = toSeconds(it->t - at) / sigma;
        const double weight = std::exp(-0.5 * std::min(d * d, 100.0));
        const Eigen::Quaterniond rotation(it->pose.R);
        const double sign = rotation.dot(reference) < 0 ? -1 : 1;
        p += weight * it->pose.p;
        q += weight * sign * rotation.coeffs();
        sum += weight;
    }
    return {Eigen::Quaterniond(q).normalized().toRotationMatrix(), p / sum};
}
}  // namespace

Motion makeReplay(
    const std::vector<RecordedPose>& recording, const ReplayConfig& config, double spacing,
    double duration, double rest)
{
    check(recording, config);
    const double recorded = toSeconds(recording.back().t - recording.front().t);
    const double needed = rest > 0 ? easedTime(duration - rest) : duration;
    if (needed > recorded)
        throw std::runtime_error(
            "the trajectory to replay '" + config.file + "' is " + std::to_string(recorded) +
            " s long; the scenario needs " + std::to_string(needed) + " s");

    // The spline reaches half its support ahead: it must not feel the start before the rest is
    // over.
    const double moving = rest + (Motion::kDegree + 1) / 2.0 * spacing;
    std::vector<Pose> controls(Motion::controlsFor(duration, spacing));
    for (std::size_t m = 0; m < controls.size(); m++)
    {
        const double t = spacing * (static_cast<double>(m) - Motion::kLead);
        const double in_recording = rest > 0 ? easedTime(t - moving) : std::max(0.0, t);
        controls[m] = config.T_world_origin * smoothPose(recording, in_recording, config.smoothing);
    }
    return {controls, spacing};
}

void declare(ConfigSection& section, ReplayConfig& config)
{
    constexpr double degree = M_PI / 180;
    section.key("file", config.file, "trajectory of the body (TUM)");
    section.key("smoothing", config.smoothing, {1e-3, 10}, "s, standard deviation of the kernel");
    Pose& T = config.T_world_origin;
    double yaw = logSO3(T.R).z() / degree;
    section.key("x", T.p.x(), kAnyNumber, "m, place of its origin in the world");
    section.key("y", T.p.y(), kAnyNumber, "m");
    section.key("z", T.p.z(), kAnyNumber, "m");
    section.key("yaw", yaw, {-180, 180}, "degrees");
    T.R = expSO3(Vector3d(0, 0, yaw * degree));
}
}  // namespace taut::simulation
