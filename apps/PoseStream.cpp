#include "PoseStream.h"

#include <poll.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <utility>

#include "taut/core/TimeText.h"
#include "taut/core/format.h"

namespace taut
{
namespace
{
std::string number(double value)
{
    return std::isfinite(value) ? format("%.9g", value) : "null";  // JSON has no others
}

std::string list(std::initializer_list<double> values)
{
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : ",") + number(value);
    return "[" + text + "]";
}

std::string list(const Vector3d& v)
{
    return list({v.x(), v.y(), v.z()});
}

/* A pipe that can be written to has room for PIPE_BUF bytes, more than a line has. */
bool hasRoom(int wait_ms)
{
    pollfd output{STDOUT_FILENO, POLLOUT, 0};
    return poll(&output, 1, wait_ms) > 0;
}
}  // namespace

PoseStream::PoseStream(WhereNobodyReads then, WarningSink warn)
    : then_(then), warn_(std::move(warn))
{
}

std::string PoseStream::lineOf(const NavEstimate& estimate, bool doubtful)
{
    const NavState& x = estimate.state;
    const Eigen::Quaterniond q(x.T_world_imu.R);
    const auto sigma = [&](int at) -> Vector3d
    { return estimate.covariance.diagonal().segment<3>(at).cwiseMax(0.0).cwiseSqrt(); };
    return "{\"t\":" + formatSeconds(x.t) + ",\"position\":" + list(x.T_world_imu.p) +
           ",\"orientation_xyzw\":" + list({q.x(), q.y(), q.z(), q.w()}) +
           ",\"velocity\":" + list(x.v_world) +
           ",\"sigma_position\":" + list(sigma(NavState::kPosition)) +
           ",\"sigma_rotation\":" + list(sigma(NavState::kRotation)) +
           ",\"doubtful\":" + (doubtful ? "true" : "false") + "}\n";
}

void PoseStream::add(const Event& event)
{
    if (std::holds_alternative<Lost>(event)) doubtful_ = true;
    if (std::holds_alternative<Recovered>(event)) doubtful_ = false;
    const auto* estimated = std::get_if<Estimated>(&event);
    if (estimated == nullptr || ended_) return;
    const NavEstimate& estimate = estimated->result.estimate;
    last_ = estimate.state.t;
    if (then_ == WhereNobodyReads::Drop && !hasRoom(0))
        dropped_++;
    else
        write(lineOf(estimate, doubtful_), last_);
}

void PoseStream::write(const std::string& line, Time t)
{
    for (std::size_t at = 0; at < line.size();)
    {
        const auto n = ::write(STDOUT_FILENO, line.data() + at, line.size() - at);
        if (n >= 0)
        {
            at += static_cast<std::size_t>(n);
            continue;
        }
        if (errno == EINTR) continue;
        if (errno == EAGAIN && hasRoom(-1)) continue;  // somebody made it so that it does not wait
        ended_ = true;
        if (warn_)
            warn_(
                {t, "stream_ended",
                 std::string("no pose is streamed any more: ") + std::strerror(errno)});
        return;
    }
}

void PoseStream::finish()
{
    if (dropped_ == 0 || !warn_) return;
    warn_(
        {last_, "stream_behind",
         std::to_string(std::exchange(dropped_, 0)) +
             " lines of --stream found no room: the reader is too slow"});
}
}  // namespace taut
