#include "taut/simulation/Weather.h"

#include <cmath>

namespace taut::simulation
{
void declare(ConfigSection& section, WeatherConfig& config)
{
    section.key("rain", config.rain, {0, 300}, "mm/h");
    section.key("dust", config.dust, {0, 10}, "1/m, extinction by dust or fog");
    section.key(
        "near_returns", config.near_returns, {0, 0.9},
        "part of the shots into the open that a drop or grain sends back");
    section.key("near_reach", config.near_reach, {0.1, 100}, "m, mean distance of those");
}

double extinction(const WeatherConfig& config)
{
    return config.dust + (config.rain > 0 ? 0.01 * std::pow(config.rain, 0.6) : 0);
}

double transmitted(const WeatherConfig& config, double range)
{
    const double lost = extinction(config);
    return lost > 0 ? std::exp(-2 * lost * range) : 1;
}

std::optional<double> nearReturn(const WeatherConfig& config, Random& random)
{
    const double luck = random.uniform();
    if (luck >= config.near_returns) return {};
    return -config.near_reach * std::log(1 - luck / config.near_returns);
}
}  // namespace taut::simulation
