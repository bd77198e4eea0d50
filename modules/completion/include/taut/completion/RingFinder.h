#pragma once

#include <string>
#include <vector>

#include "taut/core/Scan.h"

namespace taut
{
/** What a laser of a turning LiDAR sweeps: z = slope * d + height for all its points, with d the
 * horizontal distance, in the frame of the sensor. */
struct BeamCone
{
    double slope = 0;   //!< tangent of the elevation
    double height = 0;  //!< [m] of the laser above the sensor's origin
};

/** Tells which laser measured a point, in sweeps whose recording does not say.
 *
 * All points of a laser lie on its cone. Cones are found in two ways. Where a sweep holds one laser
 * after the other, each a turn, the order tells the points of a laser, and lines are fitted to
 * them: an HDL-64E has its lasers in two places above each other, so that elevations alone do not
 * part them. Elsewhere elevations are taken that many points have, and hardly any between.
 *
 * Nothing is told where it is not clear: where sweeps do not agree about the number of lasers,
 * where points are off their cones, or where cones lie too close for that. */
class RingFinder
{
 public:
    /** Judges by some sweeps of the recording, with their points in its order. True if lasers were
     * found. */
    bool learn(const std::vector<const Scan*>& scans);

    /** Sets Scan::rings and the ring of each point, that of the nearest cone. Ring 0 is the
     * highest. Nothing happens before learn() was true. */
    void apply(Scan& scan) const;

    /** From the highest to the lowest; empty if none were found. */
    const std::vector<BeamCone>& beams() const { return beams_; }

    /** What was found and how, or why nothing: a line for a summary. */
    const std::string& finding() const { return finding_; }

 private:
    bool accept(
        std::vector<std::vector<BeamCone>> of_sweeps, const std::vector<const Scan*>& scans,
        const std::string& how);
    std::size_t nearest(const LidarPoint& point, double* distance = nullptr) const;

    std::vector<BeamCone> beams_;
    std::string finding_ = "rings: not looked for";
};
}  // namespace taut
