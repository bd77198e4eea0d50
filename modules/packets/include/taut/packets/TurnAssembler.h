#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "taut/core/Scan.h"
#include "taut/core/Time.h"

namespace taut
{
/** Puts the returns of a spinning sensor together to turns, whichever way it spins. A turn ends
 * where the azimuth passes zero; for a sensor that leaves out a part of the turn, in that part: so
 * its sweep stays whole if it looks across zero. Which of both a sensor is, the first turn shows;
 * it is given out late for that. */
class TurnAssembler
{
 public:
    /** `rings` becomes that of the scans. */
    explicit TurnAssembler(int rings) : rings_(rings) {}

    /** The next block of returns: the azimuth of the head [0.01 deg, 0 to 35999] and a time near
     * its own, in the order of firing. Appends the turns that this shows to be complete: at the
     * latest after a quarter of a second. Stamps are the times of their first points. A block that
     * comes some milliseconds after a later one joins the turn that is under way. */
    void beginBlock(int azimuth, Time t, std::vector<Scan>& complete);

    /** A return of that block. */
    void add(const Eigen::Vector3f& position, float intensity, int ring, Time t);

    /** Appends what is left. */
    void finish(std::vector<Scan>& complete);

 private:
    enum class Cut
    {
        Unknown,
        AtZero,
        InGap
    };

    void step(int azimuth, std::vector<Scan>& complete);
    void close(std::vector<Scan>& complete);
    void closeAtZero(std::vector<Scan>& complete);

    int rings_;
    Cut cut_ = Cut::Unknown;
    int last_azimuth_ = -1;
    Time last_ = 0;        // of the blocks, the latest
    bool forward_ = true;  // clockwise
    int travelled_ = 0;    // [0.01 deg], since the first block or the last gap
    Time base_ = 0;        // of the points' offsets
    std::vector<LidarPoint> points_;
    std::optional<std::size_t> zero_at_;  // points before the azimuth passed zero, if not cut there
};
}  // namespace taut
