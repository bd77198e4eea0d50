#pragma once

#include <array>
#include <memory>
#include <string>

#include "taut/core/Config.h"
#include "taut/core/LoopClosure.h"
#include "taut/core/Map.h"
#include "taut/core/Submap.h"
#include "taut/loops/CommonView.h"

namespace taut
{
struct LoopJudgeConfig
{
    int points = 1500;                    //!< of each submap that are registered
    double min_overlap = 0.3;             //!< of what both could see
    double min_inliers = 0.6;             //!< of these on a surface
    double max_conflicts = 0.005;         //!< of the common cells, where the other saw free space
    double max_conflicts_between = 0.04;  //!< the same between recordings: furniture moves
    int min_cells = 150;                  //!< that both could see
    int min_sectors = 3;                  //!< of eight around, that hold inliers
    double max_disagreement = 0.05;       //!< [m] between registrations from either side and start
    double max_angle_disagreement = 0.005;  //!< [rad]
    int min_directions = 4;                 //!< of six that the overlap shows
    // Of a loop, besides what its residuals say: what both submaps have in common is wrong in both.
    double position_sigma = 0.01;   //!< [m]
    double rotation_sigma = 0.001;  //!< [rad]

    void declare(ConfigSection& section);
};

/** A submap with its surfaces. */
struct SubmapView
{
    std::shared_ptr<const Submap> submap;
    std::shared_ptr<const Map> map;  //!< of its points, submap frame
};

/** Registers two submaps and judges by what both saw whether they show the same place. What the
 * pose graph says of the gap is not asked here. */
class LoopJudge
{
 public:
    LoopJudge(const LoopJudgeConfig& config, Executor& executor)
        : config_(config), executor_(executor)
    {
    }

    /** Verdict Pending where all that was seen agrees, else Refused with the reason. */
    LoopClosure judge(
        const LoopCandidate& candidate, const SubmapView& from, const SubmapView& to) const;

 private:
    /** What speaks against it; empty: nothing. Fills the evidence as far as it got. */
    std::string faultOf(
        const LoopCandidate& candidate, const SubmapView& from, const SubmapView& to,
        LoopClosure& loop) const;
    /** The same of what both saw: `a` by the points of `to`, `b` by those of `from`. */
    std::string conflictOf(
        const CommonView& a, const CommonView& b, const std::array<std::size_t, 2>& points,
        double max_conflicts, LoopEvidence& evidence) const;

    LoopJudgeConfig config_;
    Executor& executor_;
};
}  // namespace taut
