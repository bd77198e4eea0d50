#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/Parallel.h"
#include "taut/evaluation/TrueSurface.h"
#include "taut/trajectory/Alignment.h"
#include "taut/trajectory/Statistics.h"

/** \file MapScores.h
 * How good a map is: against the true surface, and by itself. docs/evaluating.md has the
 * definitions. */
namespace taut
{
/** What is found by laying a map on the true surface. */
struct SurfaceAlignment
{
    Pose T_truth_map;
    int iterations = 0;
    int directions = 0;     //!< of the six of a pose (four for Yaw): those that the surface shows
    double near_share = 0;  //!< of the points looked at: within 0.5 m of the truth in the end, 0..1
};

/** Point-to-plane ICP from the frame that the map has, with a Geman-McClure kernel that narrows
 * from 0.5 to 0.1 m. Directions that the surface does not show stay as they are. `alignment`: SE3
 * turns and moves, Yaw turns about z alone. */
SurfaceAlignment alignToSurface(
    const std::vector<Eigen::Vector3f>& map, const TrueSurface& truth, Alignment alignment);

struct MapErrorOptions
{
    Pose T_truth_map;
    double within = 0.05;  //!< for completeness and the share of points [m]
    double reach =
        std::numeric_limits<double>::infinity();  //!< points further off are left out [m]
};

/** A map against the true surface. */
struct MapErrors
{
    Statistics distance;       //!< of the points to the truth [m]
    double percentile95 = 0;   //!< of the same [m]
    std::size_t left_out = 0;  //!< points beyond the reach
    double within = 0;         //!< as asked for [m]
    double near_share = 0;     //!< of the points counted: within that of the truth, 0..1
    double completeness = 0;   //!< of the truth, by area: a point of the map is within that, 0..1
    std::size_t samples = 0;   //!< of the truth
};

/** The same bits with any number of threads. */
MapErrors scoreMap(
    const std::vector<Eigen::Vector3f>& map, const TrueSurface& truth,
    const MapErrorOptions& options, Executor& executor);

/** How thin the walls of a map are, by itself. */
struct WallThickness
{
    static constexpr double kWindow = 0.5;  //!< diameter [m]
    std::size_t windows = 0;                //!< with enough points to judge
    std::size_t planes = 0;                 //!< of these: flat, and spread in two directions
    double median = 0, percentile90 = 0;    //!< standard deviation along the normal [m]
};

WallThickness wallThickness(const std::vector<Eigen::Vector3f>& map, Executor& executor);

/** Mean map entropy (Razlaw, Droeschel, Holz and Behnke, ECMR 2015). */
struct MapEntropy
{
    static constexpr double kRadius = 0.3;  //!< [m]
    std::size_t points = 0;                 //!< looked at
    std::size_t counted = 0;                //!< of these: with enough neighbours
    double mean = 0;                        //!< [nat]
};

MapEntropy meanMapEntropy(const std::vector<Eigen::Vector3f>& map, Executor& executor);

/** A map against its truth, and how it was laid on it. */
struct MapTruthScores
{
    bool cloud = false;
    std::size_t elements = 0;                 //!< triangles or points
    double area = 0;                          //!< of a mesh [m^2]
    double spacing = 0;                       //!< of a cloud [m]
    std::string alignment;                    //!< "trajectory", "icp", "none"
    std::optional<SurfaceAlignment> surface;  //!< of "icp"
    Pose T_truth_map;
    MapErrors errors;
};

/** All scores of a map. */
struct MapScores
{
    std::size_t points = 0;
    std::size_t not_finite = 0;  //!< left out
    WallThickness walls;
    MapEntropy entropy;
    std::optional<MapTruthScores> truth;
};

/** What to score of a map. */
struct MapOptions
{
    std::string map, truth;                //!< files; without truth the map is judged by itself
    std::optional<Pose> T_truth_map;       //!< where the trajectories tell it
    Alignment alignment = Alignment::SE3;  //!< else: for alignToSurface(), or None
    double min_near = 0.5;  //!< share of points within 0.5 m of the truth after alignToSurface()
    double within = 0.05;   //!< [m]
    double reach = std::numeric_limits<double>::infinity();  //!< [m]
};

/** Reads and scores. Throws std::runtime_error if a file cannot be used or holds more than 50
 * million points, ScoreRefused if the map cannot be laid on its truth. */
MapScores scoreMapFile(const MapOptions& options, Executor& executor);
}  // namespace taut
