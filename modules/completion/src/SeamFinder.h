#pragma once

#include <optional>
#include <vector>

#include "Panorama.h"

namespace taut
{
/** Where a sweep begins and which way it turns, told by motion alone.
 *
 * While the sensor moves, what is seen does not fit together at the azimuth where a sweep begins
 * and ends: a period lies between the points on either side. Across two sweeps it does: the end of
 * one meets the begin of the next. At every other azimuth it is the other way round. If a sweep was
 * undistorted by somebody, it fits together everywhere. */
class SeamFinder
{
 public:
    struct Seam
    {
        double azimuth = 0;  //!< [rad]
        double sense = 1;    //!< +1 if the azimuth grows with time, -1 if it falls
    };

    /** A sweep and the one after it. */
    void add(const Panorama& first, const Panorama& second);

    /** Enough motion was seen to judge. */
    bool decided() const { return pairs_ >= kPairs; }

    /** Nothing if motion does not show one. */
    std::optional<Seam> seam() const;

    /** True if motion was seen, but no place at which sweeps do not fit together. */
    bool fitsEverywhere() const;

 private:
    static constexpr int kPairs = 30;  // of sweeps between which the sensor moved

    /** How badly something fits at an azimuth, a sum over many places. */
    struct Misfit
    {
        double sum = 0, count = 0;

        double mean() const { return count > 0 ? sum / count : 0; }
    };
    struct Misfits
    {
        Misfit same, growing, falling;  //!< within a sweep; across two, by sense

        bool known() const;
        /** How much worse two sweeps fit to each other than one to itself. */
        double contrast() const { return (growing.mean() + falling.mean()) / 2 - same.mean(); }
    };

    static std::vector<Misfits> misfitsOf(const Panorama& first, const Panorama& second);
    double contrast() const;

    std::vector<Misfits> misfits_ = std::vector<Misfits>(Panorama::kBins);
    int pairs_ = 0;
};
}  // namespace taut
