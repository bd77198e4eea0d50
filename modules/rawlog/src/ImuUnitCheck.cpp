#include "ImuUnitCheck.h"

#include "taut/core/format.h"

namespace taut
{
namespace
{
constexpr Duration kWindow = 1'000'000'000;
}  // namespace

/* How gravity turns counts in the first second alone: later, a drone that tilts feels its thrust
 * along the same axis of its body all the time, as if its gyro claimed turns that never were. */
std::optional<std::string> ImuUnitCheck::add(const ImuSample& sample)
{
    judge_.add(sample);
    if (!first_) first_ = sample.t;
    const bool first_second_ends = !first_second_over_ && sample.t - *first_ >= kWindow;
    if (first_second_ends)
    {
        first_second_over_ = true;
        if (auto verdict = judgeForce()) return verdict;
    }
    if (rate_reported_) return {};
    if (!judge_.tooFastForRadians() && !(first_second_ends && judge_.gyroInDegrees())) return {};
    rate_reported_ = true;
    return "the rates cannot be in rad/s: " + judge_.units().gyro_reason +
           "; if the log has deg/s, set gyro_scale: 0.0174532925 in the rig file";
}

std::optional<std::string> ImuUnitCheck::judgeForce() const
{
    const Unit unit = accelUnit(judge_.meanForce());
    if (unit.known() && unit.factor == 1) return {};
    const std::string seen = format(
        "the mean specific force of the first second is %.3g, not 9.8 m/s^2", judge_.meanForce());
    if (!unit.known()) return seen + ": set accel_scale in the rig file";
    return seen + format(
                      "; if the log has units of %s, set accel_scale: %.6g in the rig file",
                      unit.name.c_str(), unit.factor);
}
}  // namespace taut
