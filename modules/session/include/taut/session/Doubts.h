#pragma once

#include <string>
#include <vector>

#include "taut/odometry/Events.h"

namespace taut
{
/** A stretch of time in which the pose was in doubt. */
struct Doubt
{
    Time from = 0, to = 0;
    std::string cause;  //!< kind of the warning that says why
    bool recovered = false;
};

/** Collects the stretches in which a pose was in doubt. */
class Doubts
{
 public:
    void add(const Event& event);

    const std::vector<Doubt>& all() const { return doubts_; }

    /** True if the trajectory cannot be trusted everywhere. A few scans that match nothing are
     * bridged by the IMU; a second of them is not. */
    bool serious() const;

 private:
    std::vector<Doubt> doubts_;
};
}  // namespace taut
