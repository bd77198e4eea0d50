#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "taut/core/Geometry.h"

namespace taut::simulation
{
/** Reproducible random numbers (SplitMix64; Steele et al., OOPSLA 2014), the same on every platform
 * and with every standard library. A generator is named by (seed, stream, index): parts of a
 * simulation that draw from generators of their own do not disturb one another, and may run in any
 * order. */
class Random
{
 public:
    explicit Random(std::uint64_t seed, std::uint64_t stream = 0, std::uint64_t index = 0)
        : state_(mix(mix(mix(seed) ^ stream) ^ index))
    {
    }

    std::uint64_t bits() { return mix(state_ += kGolden); }

    /** In [0, 1). */
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /** One of 0, ..., count - 1. */
    std::size_t below(std::size_t count)
    {
        return static_cast<std::size_t>(uniform() * static_cast<double>(count));
    }

    /** Normal of mean 0 and variance 1 (Box and Muller). */
    double normal()
    {
        if (has_spare_)
        {
            has_spare_ = false;
            return spare_;
        }
        const double radius = std::sqrt(-2 * std::log(1 - uniform()));
        const double angle = uniform(0, 2 * M_PI);
        spare_ = radius * std::sin(angle);
        has_spare_ = true;
        return radius * std::cos(angle);
    }

    Vector3d normalVector()
    {
        const double x = normal(), y = normal(), z = normal();
        return {x, y, z};
    }

 private:
    static constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
    static std::uint64_t mix(std::uint64_t z)
    {
        z += kGolden;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31);
    }

    std::uint64_t state_;
    double spare_ = 0;
    bool has_spare_ = false;
};

/** Puts values in a random order (Fisher and Yates). */
template <class T>
void shuffle(std::vector<T>& values, Random& random)
{
    for (std::size_t n = values.size(); n > 1; n--)
        std::swap(values[n - 1], values[random.below(n)]);
}
}  // namespace taut::simulation
