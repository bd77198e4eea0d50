#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "taut/core/Time.h"

namespace taut
{
/** What a feature may be matched with. */
enum class FeatureKind : std::uint8_t
{
    Plane,  //!< point-to-plane only
    Edge,   //!< point-to-line only
    Any,    //!< whatever the map finds around it
};

/** A raw point picked from a scan, in the IMU frame at the time of the point. */
struct Feature
{
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  //!< [m], IMU frame at its own time
    std::int32_t offset = 0;                             //!< time since Features::stamp [ns]
    FeatureKind kind = FeatureKind::Any;
};

/** The features of one scan, in the order of time. */
struct Features
{
    Time stamp = 0;  //!< reference of the offsets
    std::vector<Feature> points;
};
}  // namespace taut
