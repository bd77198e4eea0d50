#pragma once

#include <string>

#include "taut/core/PoseGraph.h"

namespace taut
{
/** Two submaps that may show the same place. */
struct LoopCandidate
{
    VertexId from = 0, to = 0;
    Pose T_from_to;  //!< a guess
    /** Of the guess, in the tangent of RelativeEdge [m, rad]. */
    Matrix6d covariance = Matrix6d::Identity();
    std::string source;               //!< who found it: "estimate", "appearance"
    bool between_recordings = false;  //!< things may have moved since
};

enum class Verdict
{
    Accepted,
    Pending,    //!< right by all that both submaps saw, yet more evidence is needed
    Refused,    //!< by what both submaps saw
    Withdrawn,  //!< accepted once, taken back as it contradicts what is known better
};
const char* nameOf(Verdict verdict);

/** What speaks for and against a loop closure. Shares are 0 to 1. */
struct LoopEvidence
{
    double overlap = 0;       //!< share of the points that both could see
    double inliers = 0;       //!< of these: on a surface of the other submap
    double conflicts = 0;     //!< of the cells that both could see: where the other saw free space
    int cells = 0;            //!< of 0.5 m that both could see
    double residual = 0;      //!< [m] root mean square of the inliers' distances
    double disagreement = 0;  //!< [m] between the registrations in both directions
    int directions = 0;       //!< of the six of a pose: that the overlap shows
    double chi2 = 0;          //!< of the gap, by the graph's own covariance; 6 degrees of freedom
    double gap = 0;           //!< [m] that the closure moves the submap relative to the graph
    double gap_angle = 0;     //!< [rad]
};

/** A candidate with what came of it; kept when refused, too. */
struct LoopClosure
{
    VertexId from = 0, to = 0;
    Pose T_from_to;
    Matrix6d information = Matrix6d::Zero();  //!< as of RelativeEdge
    LoopEvidence evidence;
    Verdict verdict = Verdict::Refused;
    std::string reason;  //!< of the verdict, in words
    std::string source;  //!< of the candidate
};
}  // namespace taut
