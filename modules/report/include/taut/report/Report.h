#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/core/Geometry.h"
#include "taut/core/Time.h"
#include "taut/core/Warning.h"

/** \file Report.h
 * What the page of a run tells, as values. Texts may hold anything: they are escaped, and bytes
 * that are not UTF-8 are replaced. */
namespace taut
{
struct ReportPoint
{
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  //!< world frame [m]
    float intensity = 0;
};

/** A pose of the body. */
struct ReportPose
{
    Time t = 0;
    Pose T_world_imu;
};

/** Values over the times of a plot; values that are not finite leave a gap. */
struct ReportCurve
{
    std::string name;
    std::vector<float> values;
    std::vector<float> half_widths;  //!< of a band around the values; empty: there is none
};

struct ReportPlot
{
    std::string title, unit;
    std::string hint;  //!< what to look for, in a sentence
    bool logarithmic = false;
    std::vector<Time> times;
    std::vector<ReportCurve> curves;  //!< each as long as `times`
};

/** Two places that were compared. */
struct ReportLoop
{
    std::string name, verdict, reason;
    bool believed = false;
    Time t_from = 0, t_to = 0;                                //!< when the body came there
    Vector3d from = Vector3d::Zero(), to = Vector3d::Zero();  //!< world frame [m]
    double gap = std::numeric_limits<double>::quiet_NaN();    //!< [m]
};

/** A stretch of time in which the pose was in doubt. */
struct ReportStretch
{
    Time from = 0, to = 0;
    std::string cause;
    bool recovered = false;
};

/** Warnings of a kind: the first of them, and how many there were. */
struct ReportWarnings
{
    std::string kind;
    std::size_t count = 0;
    std::vector<Warning> first;
};

struct ReportTable
{
    std::string title, note;
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
};

/** How far the run is from the truth. */
struct ReportAccuracy
{
    std::string headline;             //!< the main figure, or why there is none
    std::vector<ReportTable> tables;  //!< all figures
    std::vector<ReportPlot> plots;    //!< errors over time
    std::vector<Vector3d> path;       //!< the truth in the world of the run [m]
};

struct Report
{
    std::string title, subtitle;
    /** The most important figures with their names: a handful. */
    std::vector<std::pair<std::string, std::string>> headlines;
    std::vector<ReportTable> facts;
    std::vector<ReportPoint> points;  //!< those that are not finite are left out
    std::vector<ReportPose> path;     //!< in the order of time
    std::vector<ReportPlot> plots;
    std::vector<ReportLoop> loops;
    std::vector<ReportStretch> stretches;
    std::vector<ReportWarnings> warnings;
    std::vector<std::pair<std::string, std::string>>
        texts;  //!< files shown as they are: name, text
    std::optional<ReportAccuracy> accuracy;
};
}  // namespace taut
