#pragma once

#include <mrpt/rtti/CObject.h>

#include "taut/core/Config.h"
#include "taut/core/Imu.h"
#include "taut/core/NavState.h"
#include "taut/core/PreintegratedImu.h"

namespace taut
{
/** What a preintegration starts from. */
struct PreintegrationRequest
{
    Time begin = 0, end = 0;                    //!< t_{k-1}, t_k; begin < end
    const ImuSamples* samples = nullptr;        //!< should reach over both ends; may be empty
    NavState previous;                          //!< x_{k-1}: its biases are used
    Vector3d previous_rate = Vector3d::Zero();  //!< mean body rate over the interval before [rad/s]
    ImuNoise noise;
};

/** Plug point: the motion between two states as known before any LiDAR point is matched. */
class Preintegrator : public mrpt::rtti::CObject
{
    DEFINE_VIRTUAL_MRPT_OBJECT(Preintegrator)
 public:
    virtual void configure(ConfigSection& section) = 0;

    /** True if the motion comes from IMU samples: the pipeline then waits for them. */
    virtual bool needsImu() const = 0;

    /** The chain from `end` back to `begin`. Throws std::invalid_argument on an empty interval. */
    virtual PreintegratedImu integrate(const PreintegrationRequest& request) const = 0;
};
}  // namespace taut
