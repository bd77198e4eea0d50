#include "taut/inspection/InspectionReport.h"

#include <nlohmann/json.hpp>

#include "taut/core/format.h"

namespace taut
{
namespace
{
using Json = nlohmann::ordered_json;

std::string asText(const StreamProgress& log)
{
    std::string out = format(
        "%.3f s, %.1f MB\nsensors\n", toSeconds(log.now - log.first),
        static_cast<double>(log.bytes_total) / 1e6);
    for (const auto& [sensor, observations] : log.sensors)
        out += format(
            "  %-20s %-28s %8zu\n", ("'" + sensor.first + "'").c_str(), sensor.second.c_str(),
            observations);
    if (!log.findings.empty()) out += "import\n";
    for (const std::string& line : log.findings) out += "  " + line + "\n";
    return out;
}

std::string asText(const LidarFacts& f, const std::string& label)
{
    const char* place = f.stamp_at < 0.1 ? "start" : f.stamp_at > 0.9 ? "end" : "middle";
    std::string out = format(
        "LiDAR '%s'\n  %zu scans, %.2f Hz, sweeps of %.4f s, %d rings\n", label.c_str(), f.scans,
        f.rate, f.sweep, f.rings);
    out += format("  %.0f points a scan (%zu to %zu)\n", f.mean_points, f.min_points, f.max_points);
    return f.undistorted < f.scans ? out + "  stamped at the " + place + " of the sweep\n" : out;
}

std::string asText(const ImuFacts& f, const std::string& label)
{
    std::string out = format(
        "IMU '%s'\n  %zu samples, %.1f Hz, in %s and %s\n  up to %.3g rad/s and %.3g m/s^2 along "
        "an axis\n",
        label.c_str(), f.samples, f.rate, f.accel_unit.name.c_str(), f.gyro_unit.name.c_str(),
        f.max_gyro, f.max_accel);
    if (f.rest == 0) return out + "  no rest at the start\n";
    out += format("  rests for %.2f s at the start, with\n", f.rest);
    out +=
        format("    noise %.2g rad/s/sqrt(Hz), %.2g m/s^2/sqrt(Hz)\n", f.noise.gyro, f.noise.accel);
    out += format(
        "    gyro bias %.4f %.4f %.4f rad/s, specific force %.3f m/s^2\n", f.bias_gyro.x(),
        f.bias_gyro.y(), f.bias_gyro.z(), f.force_at_rest);
    return out;
}

std::string asText(const RotationFacts& f, Time first)
{
    std::string out = "LiDAR against IMU";
    if (f.end > f.begin)
        out += format(
            ", from %.1f s to %.1f s, where the body turns most", toSeconds(f.begin - first),
            toSeconds(f.end - first));
    if (!f.not_estimated.empty())
        return out +
               "\n  clock offset and extrinsic rotation cannot be estimated: " + f.not_estimated +
               "\n";
    const RotationAlignment& a = f.alignment;
    out +=
        f.offset_known
            ? format(
                  "\n  the IMU's clock is at the LiDAR's %+.2f ms +- %.2f ms\n",
                  1e3 * a.clock_offset, 1e3 * a.clock_sigma)
            : format("\n  clock offset: cannot be estimated (+- %.0f ms)\n", 1e3 * a.clock_sigma);
    out += format(
        "  extrinsic rotation: %.2f deg +- %.2f deg from the configured one\n", f.angle / kDegree,
        f.angle_sigma / kDegree);
    if (!f.rotation_known)
        out += format(
            "    not known about one axis (+- %.0f deg): the body turns too little about the "
            "others\n",
            f.worst_sigma / kDegree);
    return out;
}

std::string asText(const Finding& f, Time first)
{
    const std::string when = f.t == 0 ? "" : format(" at %.3f s", toSeconds(f.t - first));
    const std::string often = f.count > 1 ? format(" (%zu times)", f.count) : "";
    return "  [" + f.kind + "]" + when + ": " + f.text + often + "\n      " + f.advice + "\n";
}

Json asJson(const StreamProgress& log)
{
    Json out = Json::array();
    for (const auto& [sensor, observations] : log.sensors)
        out.push_back(
            {{"label", sensor.first}, {"class", sensor.second}, {"observations", observations}});
    return out;
}

double seconds(Time t)
{
    return static_cast<double>(t) * 1e-9;
}

Json asJson(const LidarFacts& f, const std::string& label)
{
    return {
        {"label", label},
        {"scans", f.scans},
        {"begin_s", seconds(f.begin)},
        {"end_s", seconds(f.end)},
        {"rate_hz", f.rate},
        {"sweep_s", f.sweep},
        {"hole_s", f.hole},
        {"points", {{"mean", f.mean_points}, {"min", f.min_points}, {"max", f.max_points}}},
        {"rings", f.rings},
        {"stamp_at", f.stamp_at},
        {"undistorted_scans", f.undistorted}};
}

Json asJson(const ImuFacts& f, const std::string& label)
{
    Json out{
        {"label", label},
        {"samples", f.samples},
        {"begin_s", seconds(f.first)},
        {"end_s", seconds(f.last)},
        {"rate_hz", f.rate},
        {"accel_unit", f.accel_unit.name},
        {"gyro_unit", f.gyro_unit.name},
        {"max_rate_rad_s", f.max_gyro},
        {"max_force_m_s2", f.max_accel},
        {"rest", nullptr}};
    if (f.rest > 0)
        out["rest"] = {
            {"duration_s", f.rest},
            {"gyro_noise", f.noise.gyro},
            {"accel_noise", f.noise.accel},
            {"gyro_bias_rad_s", {f.bias_gyro.x(), f.bias_gyro.y(), f.bias_gyro.z()}},
            {"force_m_s2", f.force_at_rest}};
    return out;
}

Json asJson(const RotationFacts& f)
{
    Json out{
        {"begin_s", seconds(f.begin)},
        {"end_s", seconds(f.end)},
        {"clock_offset", nullptr},
        {"extrinsic_rotation", nullptr}};
    if (!f.not_estimated.empty())
    {
        out["not_estimated"] = f.not_estimated;
        return out;
    }
    const RotationAlignment& a = f.alignment;
    if (f.offset_known)
        out["clock_offset"] = {{"value_s", a.clock_offset}, {"sigma_s", a.clock_sigma}};
    const Eigen::Quaterniond q(a.R_imu_lidar);
    out["extrinsic_rotation"] = {
        {"angle_deg", f.angle / kDegree},
        {"sigma_deg", f.angle_sigma / kDegree},
        {"worst_sigma_deg", f.worst_sigma / kDegree},
        {"known_about_all_axes", f.rotation_known},
        {"q_imu_lidar_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
    out["turns"] = a.turns;
    out["gyro_rate_rad_s"] = a.gyro_rate;
    out["unexplained"] = a.unexplained;
    return out;
}

Json asJson(const Finding& f, Time first)
{
    Json out{{"kind", f.kind}, {"t_s", nullptr}, {"since_start_s", nullptr}};
    if (f.t != 0)
    {
        out["t_s"] = seconds(f.t);
        out["since_start_s"] = toSeconds(f.t - first);
    }
    out["value"] = f.value;
    out["unit"] = f.unit;
    out["count"] = f.count;
    out["text"] = f.text;
    out["advice"] = f.advice;
    return out;
}
}  // namespace

std::string inspectionAsText(const Inspection& i)
{
    std::string out = asText(i.log);
    if (i.lidar) out += asText(*i.lidar, i.log.lidar_label);
    if (i.imu) out += asText(*i.imu, i.log.imu_label);
    if (i.rotation) out += asText(*i.rotation, i.log.first);
    if (i.findings.empty()) return out + "no findings\n";
    out += i.findings.size() == 1 ? "1 finding\n" : format("%zu findings\n", i.findings.size());
    for (const Finding& f : i.findings) out += asText(f, i.log.first);
    return out;
}

std::string inspectionAsJson(const Inspection& i)
{
    Json out;
    out["log"] = {
        {"first_s", seconds(i.log.first)},
        {"duration_s", toSeconds(i.log.now - i.log.first)},
        {"bytes", i.log.bytes_total},
        {"incomplete", i.incomplete}};
    out["sensors"] = asJson(i.log);
    if (!i.log.findings.empty()) out["import"] = i.log.findings;
    out["lidar"] = i.lidar ? asJson(*i.lidar, i.log.lidar_label) : Json();
    out["imu"] = i.imu ? asJson(*i.imu, i.log.imu_label) : Json();
    out["rotation"] = i.rotation ? asJson(*i.rotation) : Json();
    out["findings"] = Json::array();
    for (const Finding& f : i.findings) out["findings"].push_back(asJson(f, i.log.first));
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}
}  // namespace taut
