#pragma once

#include <chrono>

namespace taut
{
/** Adds the time since its last call to a stage. */
class Stopwatch
{
 public:
    void stage(double& milliseconds)
    {
        const auto now = std::chrono::steady_clock::now();
        milliseconds += std::chrono::duration<double, std::milli>(now - last_).count();
        last_ = now;
    }

 private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};
}  // namespace taut
