#include "taut/session/Metrics.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

namespace taut
{
namespace
{
std::string sha256(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(
        EVP_MD_CTX_new(), &EVP_MD_CTX_free);
    EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
    std::vector<char> buffer(1 << 20);
    while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) ||
           file.gcount() > 0)
        EVP_DigestUpdate(context.get(), buffer.data(), static_cast<std::size_t>(file.gcount()));
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    EVP_DigestFinal_ex(context.get(), digest.data(), &size);
    std::ostringstream hex;
    for (unsigned i = 0; i < size; i++)
        hex << "0123456789abcdef"[digest[i] >> 4] << "0123456789abcdef"[digest[i] & 15];
    return hex.str();
}

/** Nothing for a folder. */
nlohmann::ordered_json fingerprint(const std::string& path)
{
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) return nullptr;
    return sha256(path);
}

double megabytes(std::size_t kilobytes)
{
    return static_cast<double>(kilobytes) / 1024;
}
nlohmann::ordered_json slamOf(const Metrics::Summary& s)
{
    return {
        {"submaps", s.submaps},
        {"loops_judged", s.loops_judged},
        {"loops_accepted", s.loops_accepted},
        {"loops_pending", s.loops_pending},
        {"loops_withdrawn", s.loops_withdrawn},
        {"path_corrected", s.path_corrected},
        {"undistorted_again", s.second_pass},
        {"drift_scale", s.drift_scale},
        {"seconds", s.slam_seconds},
        {"second_pass_s", s.second_pass_seconds},
        {"moved_points", s.moved_points},
        {"moved_s", s.moved_seconds}};
}
nlohmann::ordered_json liveOf(const LiveSummary& live)
{
    nlohmann::ordered_json j{
        {"load", live.load},
        {"scans", live.scans},
        {"late_scans", live.late},
        {"caught_up_s", live.caught_up},
        {"latency_ms",
         {{"median", 1e3 * live.median},
          {"percentile_99", 1e3 * live.percentile_99},
          {"worst", 1e3 * live.worst}}}};
    j["reduced"] = nlohmann::ordered_json::array();
    for (const LiveSummary::Reduced& r : live.reduced)
        j["reduced"].push_back(
            {{"from", static_cast<double>(r.from) * 1e-9},
             {"to", static_cast<double>(r.to) * 1e-9},
             {"share", r.share}});
    return j;
}
}  // namespace

std::size_t residentMemory(bool peak)
{
    const std::string key = peak ? "VmHWM:" : "VmRSS:";
    std::ifstream status("/proc/self/status");
    std::string word;
    std::size_t kilobytes = 0;
    while (status >> word)
        if (word == key) status >> kilobytes;
    return kilobytes;
}

Metrics::Metrics(std::string input) : input_(std::move(input)) {}

void Metrics::add(const ScanResult& result)
{
    if (scans_ == 0) first_ = result.estimate.state.t;
    last_ = result.estimate.state.t;
    if (scans_ > 0 && !result.report.lidar_used) unmatched_++;
    if (!result.report.converged) not_converged_++;
    total_ms_ += result.report.times.total();
    max_ms_ = std::max(max_ms_, result.report.times.total());
    iterations_ += result.report.iterations;
    correspondences_ += result.report.correspondences;
    memory_.add(residentMemory(false));
    scans_++;
}

std::string Metrics::json(const Summary& s, const WarningLog& warnings) const
{
    const double log_span = toSeconds(s.log.now - s.log.first);
    const double n = std::max(1, scans_);
    nlohmann::ordered_json j;
    j["program"] = {{"name", "taut-slam"}, {"version", TAUT_VERSION}};
    j["input"] = {
        {"file", input_},
        {"sha256", fingerprint(input_)},
        {"bytes", s.log.bytes_total},
        {"duration_s", log_span},
        {"scans", s.log.scans},
        {"imu_samples", s.log.imu_samples},
        {"skipped_observations", s.log.skipped},
        {"points_not_finite", s.log.points_not_finite},
        {"points_with_wrong_time", s.log.points_bad_time},
        {"incomplete", s.incomplete},
        {"lidar_label", s.log.lidar_label},
        {"imu_label", s.log.imu_label}};
    if (!s.log.findings.empty()) j["input"]["import"] = s.log.findings;
    j["method"] = {
        {"file", s.method_file},
        {"undistortion", s.mode},
        {"threads", s.threads},
        {"with_imu", s.with_imu},
        {"rest_s", s.rest_seconds}};
    j["result"] = {
        {"poses", scans_},
        {"duration_s", duration()},
        {"length_m", s.length},
        {"coverage", log_span > 0 ? duration() / log_span : 0},
        {"interrupted", s.interrupted},
        {"unmatched_scans", unmatched_},
        {"not_converged_scans", not_converged_},
        {"mean_iterations", iterations_ / n},
        {"mean_correspondences", correspondences_ / n}};
    j["doubtful"] = nlohmann::ordered_json::array();
    for (const Doubt& d : s.doubts)
        j["doubtful"].push_back(
            {{"from", static_cast<double>(d.from) * 1e-9},
             {"to", static_cast<double>(d.to) * 1e-9},
             {"cause", d.cause},
             {"recovered", d.recovered}});
    j["map"] = {
        {"points", s.map_points},
        {"window_cells", s.map_cells},
        {"key_scans", s.key_scans},
        {"occupancy_resolution_m", s.occupancy_resolution}};
    if (s.live) j["live"] = liveOf(*s.live);
    if (s.with_slam) j["slam"] = slamOf(s);
    j["frames"] =
        "trajectory: pose of the IMU body in the world (z up, origin at the first state), at the "
        "end "
        "of each scan";
    j["time"] = {
        {"mean_ms_per_scan", total_ms_ / n},
        {"max_ms_per_scan", max_ms_},
        {"wall_s", s.wall_seconds},
        {"times_real_time", s.wall_seconds > 0 ? duration() / s.wall_seconds : 0}};
    nlohmann::ordered_json quarters = nlohmann::ordered_json::array();
    const std::vector<std::size_t>& memory = memory_.items();
    if (!memory.empty())
        for (const std::size_t q : {1, 2, 3, 4})
            quarters.push_back(megabytes(memory[(memory.size() - 1) * q / 4]));
    j["memory"] = {{"peak_mb", megabytes(residentMemory(true))}, {"mb_at_each_quarter", quarters}};
    j["warnings"] = nlohmann::ordered_json::object();
    for (const auto& [kind, count] : warnings.counts()) j["warnings"][kind] = count;
    for (const Warning& w : warnings.kept())
        j["first_warnings"].push_back(
            {{"t", static_cast<double>(w.t) * 1e-9}, {"kind", w.kind}, {"text", w.text}});
    // Names of files may hold any bytes.
    return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}
}  // namespace taut
