#pragma once

#include <optional>

#include "taut/core/Config.h"
#include "taut/simulation/Random.h"

namespace taut::simulation
{
/** What is in the air between the sensor and the surfaces. */
struct WeatherConfig
{
    double rain = 0;          //!< rate [mm/h]
    double dust = 0;          //!< extinction by dust or fog [1/m]
    double near_returns = 0;  //!< part of the shots into the open that a drop or grain sends back
    double near_reach = 3;    //!< mean distance of those, distributed exponentially [m]
};

void declare(ConfigSection& section, WeatherConfig& config);

/** Part of the light that is lost on a metre [1/m]: dust, and 0.01 R^0.6 of rain (Goodin et al.,
 * Electronics 8(1), 89, 2019). */
double extinction(const WeatherConfig& config);

/** Light that is left of a shot there and back. */
double transmitted(const WeatherConfig& config, double range);

/** How far away a drop or grain sends a shot back, if one does [m]. Draws one number. */
std::optional<double> nearReturn(const WeatherConfig& config, Random& random);
}  // namespace taut::simulation
