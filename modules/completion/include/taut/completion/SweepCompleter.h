#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/completion/RingFinder.h"
#include "taut/completion/TurnFinder.h"
#include "taut/core/Scan.h"

namespace taut
{
/** Gives sweeps what their recording left out: the times of their points, and their rings. It
 * learns from the first sweeps of a recording and then completes all of them, those again. */
class SweepCompleter
{
 public:
    /** `undistorted`: it is known that somebody undistorted the sweeps, so that points have no
     * times of their own. */
    explicit SweepCompleter(ScanTimes times = ScanTimes::Auto, bool undistorted = false)
        : undistorted_(undistorted), turn_(undistorted ? ScanTimes::None : times)
    {
    }

    /** A sweep of the beginning, as the recording has it, in the order of time. False if no more
     * are needed. */
    bool learn(Scan scan);

    /** A sample of the IMU among them; none are needed, but they may tell what stamps are. */
    void learn(const ImuSample& sample) { turn_.learn(sample); }

    /** Judges what was learnt. */
    void finishLearning();

    /** From one sweep to the next [ns], where the times of points are told; else 0. */
    Duration interval() const { return turn_.interval(); }

    /** See TurnFinder. */
    std::optional<bool> stampIsEnd() const { return turn_.stampIsEnd(); }

    /** The stamps of sweeps whose times are told are those of their ends, not of their begins. */
    void setStampIsEnd(bool is_end) { stamp_is_end_ = is_end; }

    /** Completes a sweep. Nothing happens to one that has all, nor where nothing was found. */
    void complete(Scan& scan) const;

    /** What was found out, one line each; empty if nothing was left out. */
    const std::vector<std::string>& findings() const { return findings_; }

 private:
    void learnRings();

    bool undistorted_;
    RingFinder rings_;
    TurnFinder turn_;
    std::vector<Scan> first_;  // until the rings are judged by them
    bool rings_judged_ = false, no_times_ = false, turn_is_learnt_ = false;
    bool stamp_is_end_ = false;
    std::vector<std::string> findings_;
};
}  // namespace taut
