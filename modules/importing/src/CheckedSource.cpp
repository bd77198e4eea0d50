#include "CheckedSource.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "taut/core/format.h"

namespace taut
{
namespace
{
constexpr Duration kJudged = 2'000'000'000;
constexpr std::size_t kMostScansHeld = 25;
constexpr std::size_t kFewestSamples = 10, kFewestScans = 3;

std::string line(const std::string& what, const Unit& unit, const std::string& reason)
{
    return what + " in " + unit.name + (unit.factor == 1 ? "" : ", converted") + " (" + reason +
           ")";
}
StampOrder::Sensor sensorOf(const ImportedItem& item)
{
    return std::holds_alternative<ImuSample>(item) ? StampOrder::Sensor::Imu
                                                   : StampOrder::Sensor::Lidar;
}

Time stampOf(const ImportedItem& item)
{
    if (const auto* sample = std::get_if<ImuSample>(&item)) return sample->t;
    if (const auto* scan = std::get_if<Scan>(&item)) return scan->stamp;
    return std::get<PacketScan>(item).stamp;
}

void move(ImuSample& sample, Duration shift)
{
    sample.t += shift;
}

void move(Scan& scan, Duration shift)
{
    scan.stamp += shift;
    scan.end += shift;
}

void move(PacketScan& scan, Duration shift)
{
    scan.stamp += shift;
}
}  // namespace

CheckedSource::CheckedSource(
    std::string path, std::unique_ptr<ImportSource> source, const ImportOptions& options,
    WarningSink warn)
    : path_(std::move(path)), source_(std::move(source)), options_(options), warn_(std::move(warn))
{
}

std::optional<ImportedItem> CheckedSource::next()
{
    while (!judged_)
    {
        auto item = nextValid();
        if (item && samples_ == 0) return item;  // the units are not known before there are samples
        if (item) held_.push_back(std::move(*item));
        if (!item || held_scans_ >= kMostScansHeld ||
            (last_sample_ && *last_sample_ - first_sample_ >= kJudged))
            judge();
    }
    std::optional<ImportedItem> item;
    if (held_.empty())
    {
        item = nextValid();
    }
    else
    {
        item = std::move(held_.front());
        held_.pop_front();
    }
    if (!item) finish();
    if (auto* sample = item ? std::get_if<ImuSample>(&*item) : nullptr) convert(*sample);
    return item;
}

void CheckedSource::convert(ImuSample& sample)
{
    sample.accel *= units_.accel.factor;
    sample.gyro *= units_.gyro.factor;
    if (sample.gyro.norm() <= kFastestRate || std::exchange(too_fast_, true)) return;
    warn(
        sample.t, "imu_units",
        "a rate of " + std::to_string(sample.gyro.norm()) +
            " rad/s: no gyro gets there; left as it is");
}

std::optional<ImportedItem> CheckedSource::nextInOrder()
{
    while (true)
    {
        while (!all_read_ && !order_.ready())
        {
            auto item = source_->next();
            all_read_ = !item;
            if (item)
                ahead_.emplace(order_.push(sensorOf(*item), stampOf(*item)), std::move(*item));
        }
        const auto judged = order_.pop();
        if (!judged) return {};
        ImportedItem item = std::move(ahead_.at(judged->id));
        ahead_.erase(judged->id);
        const bool outlier = judged->verdict == StampOrder::Verdict::Outlier;
        if (judged->verdict != StampOrder::Verdict::Good)
        {
            const bool is_sample = std::holds_alternative<ImuSample>(item);
            const auto finding = findingOf(*judged, is_sample ? "a sample of the IMU" : "a scan");
            warn(stampOf(item), finding.kind, finding.text + (outlier ? "; left out" : ""));
        }
        if (outlier) continue;
        std::visit([&](auto& i) { move(i, judged->shift); }, item);
        return item;
    }
}

std::optional<ImportedItem> CheckedSource::nextValid()
{
    while (auto item = nextInOrder())
        if (std::visit([this](const auto& i) { return valid(i); }, *item))
        {
            if (std::holds_alternative<ImuSample>(*item)) return item;
            if (scans_++ == 0) first_scan_ = *last_scan_;
            if (samples_ > 0) held_scans_++;
            return item;
        }
    return {};
}

bool CheckedSource::valid(const ImuSample& sample)
{
    if (!sample.accel.allFinite() || !sample.gyro.allFinite())
    {
        warn(sample.t, "imu_invalid", "a value of the IMU is not finite; left out");
        return false;
    }
    if (!isLater(sample.t, last_sample_, "imu_time", "sample of the IMU")) return false;
    if (samples_++ == 0) first_sample_ = sample.t;
    judge_.add(sample);
    return true;
}

bool CheckedSource::isLater(
    Time t, std::optional<Time>& last, const std::string& kind, const std::string& what)
{
    if (last && t <= *last)
    {
        warn(
            t, kind,
            "a " + what + " is stamped " + std::to_string(toSeconds(*last - t)) +
                " s before the one before it; left out");
        return false;
    }
    last = t;
    return true;
}

void CheckedSource::judge()
{
    judged_ = true;
    if (samples_ >= kFewestSamples) units_ = judge_.units();
    if (options_.accel_scale)
    {
        const double factor = *options_.accel_scale;
        units_.accel = {"units of " + std::to_string(factor) + " m/s^2", factor};
        units_.accel_reason = "as told";
    }
    if (options_.gyro_scale)
    {
        const double factor = *options_.gyro_scale;
        units_.gyro = {"units of " + std::to_string(factor) + " rad/s", factor};
        units_.gyro_reason = "as told";
    }
    if (!units_.accel.known())
        warn(
            first_sample_, "imu_units",
            "specific force: " + units_.accel_reason +
                ", near gravity in no unit; left as it is: give accel_scale in a rig file");
}

/* What the first seconds could not tell, the whole recording may. */
void CheckedSource::finish()
{
    if (std::exchange(finished_, true)) return;
    if (!last_scan_) throw std::runtime_error("no scan in '" + path_ + "' can be used");
    if (samples_ < kFewestSamples) return;
    compareSpans();
    const ImuUnits all = judge_.units();
    const auto contradict = [this](
                                const std::string& what, const std::string& taken,
                                const std::string& later, const std::string& reason)
    {
        warn(
            first_sample_, "imu_units",
            what + " were taken as " + taken + ", but later ones speak for " + later + " (" +
                reason + "): tell the unit by a rig file and import again");
    };
    if (!options_.gyro_scale && all.gyro.factor != units_.gyro.factor)
        contradict("the rates", units_.gyro.name, all.gyro.name, all.gyro_reason);
    if (!options_.accel_scale && all.accel.factor != units_.accel.factor)
        contradict("the forces", units_.accel.name, all.accel.name, all.accel_reason);
}

/* Sensors that were recorded together were recorded at the same time. */
void CheckedSource::compareSpans() const
{
    const Duration offset = fromSeconds(options_.lidar_clock_offset);
    const Time first = first_scan_ + offset, last = *last_scan_ + offset;
    const Duration common = std::min(last, *last_sample_) - std::max(first, first_sample_);
    const Duration shorter = std::min(last - first, *last_sample_ - first_sample_);
    if (scans_ < kFewestScans || 2 * common >= shorter) return;
    warn(
        first, "clock_offset",
        format(
            "by their stamps, the LiDAR was recorded from %.3f to %.3f s and the IMU from %.3f to "
            "%.3f s: if these were the same time, a rig file (-r) with lidar: {clock_offset: %.3f} "
            "or so corrects that",
            toSeconds(first), toSeconds(last), toSeconds(first_sample_), toSeconds(*last_sample_),
            toSeconds(first_sample_ - first_scan_)));
}

std::vector<std::string> CheckedSource::findings() const
{
    auto lines = source_->findings();
    if (samples_ == 0) return lines;
    if (samples_ < kFewestSamples)
    {
        lines.emplace_back("IMU: too few samples to judge their units");
        return lines;
    }
    lines.push_back(line("specific force", units_.accel, units_.accel_reason));
    lines.push_back(line("rates", units_.gyro, units_.gyro_reason));
    return lines;
}

void CheckedSource::warn(Time t, const std::string& kind, const std::string& text) const
{
    if (warn_) warn_({t, kind, text});
}
}  // namespace taut
