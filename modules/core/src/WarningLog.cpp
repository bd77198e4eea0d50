#include "taut/core/WarningLog.h"

#include <utility>

namespace taut
{
WarningLog::WarningLog(WarningSink next, std::size_t keep) : next_(std::move(next)), keep_(keep) {}

void WarningLog::add(const Warning& warning)
{
    if (++counts_[warning.kind] > keep_) return;
    kept_.push_back(warning);
    if (next_) next_(warning);
}

WarningSink WarningLog::sink()
{
    return [this](const Warning& warning) { add(warning); };
}

std::size_t WarningLog::count(const std::string& kind) const
{
    const auto it = counts_.find(kind);
    return it == counts_.end() ? 0 : it->second;
}

std::string WarningLog::summaryOfRest() const
{
    std::string text;
    for (const auto& [kind, n] : counts_)
        if (n > keep_)
            text += kind + ": " + std::to_string(n) + " times, of which the first " +
                    std::to_string(keep_) + " were reported\n";
    return text;
}
}  // namespace taut
