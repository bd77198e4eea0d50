#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "../bag/SweepClock.h"
#include "NameStamps.h"
#include "taut/core/Scan.h"
#include "taut/importing/ImportOptions.h"

namespace taut
{
/** True if its ending is one that readCloud() knows. */
bool isCloud(const std::filesystem::path& file);

/** A cloud as its file has it. */
struct RawCloud
{
    enum class Times
    {
        None,
        Absolute,    //!< column t or t_ns
        SinceStamp,  //!< column dt or dt_ns
        Judged       //!< another column: what it means is told by the clouds
    };
    Times kind = Times::None;
    double unit = 1;  //!< of the times [ns], unless they are judged
    std::string time_field;
    std::optional<Time> stamp;       //!< that its name is
    std::vector<LidarPoint> points;  //!< all of them; offsets not set
    std::vector<double> times;       //!< of all points; empty if there are none
};

/** Reads the clouds of a folder. What a column means that has no fixed meaning, and the range of
 * intensities, are judged by the first of them. */
class CloudReader
{
 public:
    CloudReader(
        const std::vector<std::filesystem::path>& files, NameStamps names,
        const ImportOptions& options, WarningSink warn);

    /** The scan; its stamp is the time of the first point. Throws std::runtime_error naming the
     * file and what is missing or wrong in it. */
    Scan read(const std::filesystem::path& file);

    /** What was judged, a line each. */
    std::vector<std::string> findings() const;

 private:
    RawCloud readRaw(const std::filesystem::path& file) const;
    void learn(const std::vector<std::filesystem::path>& files);
    Scan toScan(const RawCloud& cloud);
    bag::RawSweep toSweep(const RawCloud& cloud) const;

    NameStamps names_;
    std::string time_field_;
    bag::SweepClock clock_;
    double intensity_scale_ = 1;
};

/** The scan of one file (docs/importing.md), as CloudReader reads it. */
Scan readCloud(const std::filesystem::path& file);
}  // namespace taut
