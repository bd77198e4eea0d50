#pragma once

#include <mrpt/rtti/CObject.h>

#include "taut/core/Config.h"
#include "taut/core/Features.h"
#include "taut/core/Scan.h"
#include "taut/core/Warning.h"

namespace taut
{
/** Plug point: picks the points of a scan that are worth matching. */
class FeatureExtractor : public mrpt::rtti::CObject
{
    DEFINE_VIRTUAL_MRPT_OBJECT(FeatureExtractor)
 public:
    virtual void configure(ConfigSection& section) = 0;

    /** Features of a scan in the IMU frame (after transformScan), sorted by time. Deterministic. A
     * scan that gives too few is thinned less; one that has too few points gets a warning. */
    virtual Features extract(const Scan& scan, const WarningSink& warn) const = 0;
};
}  // namespace taut
