#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "taut/trajectory/Alignment.h"
#include "taut/trajectory/RelativeErrors.h"
#include "taut/trajectory/Statistics.h"

namespace taut
{
/** The error of one pose, after alignment. */
struct PoseError
{
    Time t = 0;
    double position = 0;      //!< [m]
    double rotation_deg = 0;  //!< angle between the attitudes [deg]
};

/** Absolute trajectory error. */
struct AbsoluteError
{
    Pose T_truth_estimate;          //!< the alignment used
    std::vector<PoseError> errors;  //!< one a pair
    Statistics position;            //!< [m]
    Statistics rotation_deg;        //!< [deg]
};

AbsoluteError absoluteError(const PosePairs& pairs, const Pose& T_truth_estimate);

/** How much of the truth the estimate says something about. */
struct Coverage
{
    double share = 0;        //!< of the truth's span [0..1], gaps left out
    double truth_span = 0;   //!< [s]
    double late_start = 0;   //!< from the truth's first pose to the estimate's first [s], >= 0
    double early_end = 0;    //!< from the estimate's last pose to the truth's last [s], >= 0
    double largest_gap = 0;  //!< between neighbours of the estimate [s]
};

/** A spacing of the estimate above `max_gap` [ns] covers nothing; 0 takes three times its median
 * spacing. */
Coverage coverageOf(const Trajectory& truth, const Trajectory& estimate, Duration max_gap = 0);

/** What to score, and what is too little to be scored. */
struct ScoreOptions
{
    Alignment alignment = Alignment::SE3;
    Pose T_truth_estimate;                   //!< of Alignment::Given
    std::vector<double> rpe_seconds{1, 10};  //!< [s]
    std::vector<double> rpe_metres{1, 10};   //!< [m]
    double min_coverage = 0.5;               //!< share of the truth's span
    std::size_t min_poses = 10;              //!< poses of the estimate with a truth
    Duration max_truth_gap = 0;              //!< [ns]; 0: three times the median spacing
    Duration max_estimate_gap = 0;           //!< [ns]; 0: three times the median spacing
};

/** The estimate is too little to be scored; what() says by how much. */
struct ScoreRefused : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

struct Scores
{
    PosePairs pairs;  //!< what was scored
    std::size_t truth_poses = 0, estimate_poses = 0;
    bool at_truth_poses = false;  //!< it has fewer a second: the estimate is interpolated
    Coverage coverage;
    double truth_path = 0;     //!< length along the paired poses [m]
    double estimate_path = 0;  //!< [m]
    Alignment alignment = Alignment::SE3;
    AbsoluteError absolute;
    std::vector<RelativeError> over_time, over_distance;  //!< one for each delta asked for
    SegmentErrors kitti;                                  //!< 100 to 800 m
    SegmentErrors short_segments;                         //!< 5 to 40 m
};

/** Every score of an estimate. Throws ScoreRefused where it covers too little, std::runtime_error
 * where the alignment is not determined. */
Scores scoreTrajectory(
    const Trajectory& truth, const Trajectory& estimate, const ScoreOptions& options = {});
}  // namespace taut
