#include "LogFindings.h"

#include <algorithm>
#include <iterator>

#include "taut/core/format.h"

namespace taut
{
namespace
{
/** Warnings of the import of a recording that is no rawlog. */
constexpr const char* kOfImport[] = {
    "bag_damaged",    "bag_file_missing", "bag_truncated",   "bag_unindexed", "fragments_lost",
    "no_calibration", "packet_invalid",   "message_invalid", "packets_late",  "pcap_cut",
    "pcap_truncated", "pose_unknown",     "scan_stamp",      "second_sensor", "tf_invalid"};

/** What to do about a kind of warning; empty for kinds that are found in a better way elsewhere. */
std::string adviceFor(const std::string& kind)
{
    static const std::map<std::string, std::string> advice{
        {"rawlog_truncated",
         "copy the file again or record again; what is before the damage can be used"},
        {"no_stamp", "let the driver stamp its observations"},
        {"stamp_outlier", "let the driver check its stamps; what carries one is left out"},
        {"imu_order",
         "packets came in the wrong order: the samples are sorted; if it happens often, let the "
         "recorder write in the order of time"},
        {"clock_back",
         "keep NTP from stepping the clock while recording; later stamps are moved by as much"},
        {"imu_time",
         "a clock was set back while recording, or packets came in the wrong order: keep NTP from "
         "stepping the clock; the samples are skipped"},
        {"imu_duplicate",
         "the driver gives readings twice or stamps them too coarsely; the second of each is "
         "skipped"},
        {"scan_time",
         "a clock was set back while recording, or packets came in the wrong order: keep NTP from "
         "stepping the clock; the scans are skipped"},
        {"scan_duplicate",
         "the driver gives scans twice or stamps them too coarsely; the second of each is skipped"},
        {"imu_invalid", "let the driver give rates and specific forces in each sample"},
        {"imu_outlier",
         "bytes are lost or swapped between sensor and recorder, or the units are wrong; such "
         "samples are left out"},
        {"imu_units", "look at the units and set the scales in the rig file"},
        {"imu_late", "start the IMU before the LiDAR, or cut the start off with --from-time"},
        {"scan_overlap",
         "the times of the points and the stamps come from different clocks: stamp by the "
         "sensor's clock"},
        {"scan_times",
         "nothing if the text is right; better record points with times; --scan-times none if the "
         "scans are undistorted"},
        {"scan_invalid", "see the text; the scans are skipped"},
        {"scan_empty", "is the sensor covered, or still starting? the scans are skipped"},
        {"rig_unused", "correct the label in the rig file"},
        {"imu_not_found", "correct the label"}};
    const auto it = advice.find(kind);
    if (it != advice.end()) return it->second;
    const bool of_import =
        std::find(std::begin(kOfImport), std::end(kOfImport), kind) != std::end(kOfImport);
    return of_import ? "see docs/warnings.md, taut-import" : "";
}

Finding pointFinding(
    Time t, const std::string& kind, std::size_t bad, std::size_t seen, const std::string& what,
    const std::string& advice)
{
    const double percent = 100 * static_cast<double>(bad) / static_cast<double>(seen);
    return {
        t,       kind,
        percent, "%",
        bad,     format("%zu of %zu points (%.2g %%) ", bad, seen, percent) + what + ": dropped",
        advice};
}
}  // namespace

void LogFindings::add(const Warning& warning)
{
    const std::string advice = adviceFor(warning.kind);
    if (advice.empty()) return;
    const auto [it, is_new] = by_kind_.try_emplace(warning.kind);
    Finding& f = it->second;
    if (is_new) f = {warning.t, warning.kind, 0, "", 0, warning.text, advice};
    f.count++;
    f.value = static_cast<double>(f.count);
}

void LogFindings::watch(const StreamProgress& progress)
{
    if (first_nan_ == 0 && progress.points_not_finite > 0) first_nan_ = progress.now;
    if (first_bad_time_ == 0 && progress.points_bad_time > 0) first_bad_time_ = progress.now;
}

Findings LogFindings::findings(const StreamProgress& progress, bool own_units) const
{
    Findings found;
    for (const auto& [kind, finding] : by_kind_)
        if (kind != "imu_units" || !own_units) found.push_back(finding);
    if (progress.points_not_finite > 0)
        found.push_back(pointFinding(
            first_nan_, "nan_points", progress.points_not_finite, progress.points,
            "have coordinates that are not finite",
            "harmless where the driver marks missing returns so; else look at the driver"));
    if (progress.points_bad_time > 0)
        found.push_back(pointFinding(
            first_bad_time_, "point_times", progress.points_bad_time, progress.points,
            "have a time that is not in their sweep",
            "the times of the points and the stamps come from different clocks, or are in "
            "different units"));
    return found;
}
}  // namespace taut
