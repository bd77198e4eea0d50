#include "taut/render/Caption.h"

#include <array>
#include <cstdio>

namespace taut
{
std::vector<std::string> captionOf(const RunFacts& run)
{
    std::array<char, 100> text{};
    std::snprintf(
        text.data(), text.size(), "length %.1f m, duration %.1f s", run.length,
        toSeconds(run.duration));
    std::string line = text.data();
    if (!run.mode.empty()) line += ", mode " + run.mode;
    return {run.sequence, line};
}
}  // namespace taut
