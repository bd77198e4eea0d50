#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "taut/core/Warning.h"

namespace taut
{
/** Counts warnings by kind, keeps the first few of each kind and passes those on, so that a fault
 * that repeats with every sample neither floods the terminal nor gets lost. Not thread-safe. */
class WarningLog
{
 public:
    /** `next` (may be empty) gets the first `keep` warnings of each kind. */
    explicit WarningLog(WarningSink next = {}, std::size_t keep = 3);

    void add(const Warning& warning);

    /** A sink that adds to this log, which must outlive it. */
    WarningSink sink();

    const std::map<std::string, std::size_t>& counts() const { return counts_; }
    std::size_t count(const std::string& kind) const;
    /** The first few of each kind, in the order they came. */
    const std::vector<Warning>& kept() const { return kept_; }
    /** One line for each kind that came more often than was passed on; empty text if there is none.
     */
    std::string summaryOfRest() const;

 private:
    WarningSink next_;
    std::size_t keep_;
    std::map<std::string, std::size_t> counts_;
    std::vector<Warning> kept_;
};
}  // namespace taut
