#include "taut/rawlog/RawlogSource.h"

#include <mrpt/obs/CObservationIMU.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "ErrorText.h"
#include "ImuUnitCheck.h"
#include "MrptConversion.h"
#include "ObservationReader.h"
#include "ObservationToScan.h"
#include "SensorChoice.h"
#include "taut/completion/SweepCompleter.h"
#include "taut/core/NameExpression.h"
#include "taut/core/format.h"
#include "taut/rawlog/StampOrder.h"

namespace taut
{
using mrpt::obs::CObservation;
using mrpt::obs::CObservationIMU;

namespace
{
constexpr Duration kLookahead = 2'000'000'000;     // in it the sensors must show up
constexpr std::size_t kLookaheadCount = 20'000;    // whatever the stamps say
constexpr std::size_t kLookaheadBytes = 1u << 28;  // likewise
constexpr Duration kDisorder = 1'000'000'000;      // between sensors, in the order of the file
constexpr Duration kLongestScan = 400'000'000;     // [ns] the IMU covers one that begins at the end
constexpr Duration kLargestOverlap = 20'000'000;   // of sweeps that follow each other
constexpr double kWorstBadShare = 0.05;            // of the points of a scan

std::string seconds(Duration d)
{
    std::ostringstream s;
    s.precision(6);
    s << std::fixed << toSeconds(d) << " s";
    return s.str();
}

const std::string& firstGiven(const std::string& a, const std::string& b)
{
    return a.empty() ? b : a;
}
}  // namespace

bool isRawlog(const std::string& path)
{
    try
    {
        const ObservationReader reader(path);
        return true;
    }
    catch (const std::runtime_error&)
    {
        return false;
    }
}

struct RawlogSource::Impl
{
    Impl(const RawlogConfig& c, WarningSink w)
        : config(c),
          sink(std::move(w)),
          reader(openEntries(c, sink)),
          lidar("LiDAR", "--lidar", firstGiven(c.lidar_label, c.rig.lidar.label)),
          imu("IMU", "--imu", firstGiven(c.imu_label, c.rig.imu.label)),
          order(c.wait_for_growth ? StampOrder::Judge::AtOnce : StampOrder::Judge::Later)
    {
        progress.pose_told = reader->tellsPose();
        lookAhead();
        if (config.from_time > 0) begin = progress.first + fromSeconds(config.from_time);
        if (config.to_time < 1e9) end = progress.first + fromSeconds(config.to_time);
    }

    std::optional<Measurement> next();

 private:
    /** An observation with the verdict on its stamp. */
    struct Judged
    {
        CObservation::Ptr observation;
        StampOrder::Judged stamp;
    };

    void lookAhead();
    std::optional<Judged> judge();
    bool take();
    std::optional<LogEntry> read();
    void account(const LogEntry& entry);
    template <class RigPart>
    void choose(
        SensorChoice& choice, const std::string& label, RigPart& rig, std::string& chosen_label);
    void setBody(const CObservationIMU& observation);
    std::optional<Measurement> convert(const Judged& judged);
    std::optional<Measurement> convertImu(const CObservationIMU& observation, Duration shift);
    std::optional<Measurement> convertLidar(const CObservation& observation, Duration shift);
    bool withinRange(const ImuSample& sample);
    bool checkImuTime(Time t);
    void completeTimes(Scan& scan);
    void learnTimes(Time t);
    bool checkScanTime(const Scan& scan);
    void checkPoints(const ScanBuilder& points, Time t);
    Pose lidarPose(const CObservation& observation) const;
    bool enoughScans() const;
    bool beyondEnd(Time t) const;
    void finish();
    void warn(Time t, const std::string& kind, const std::string& text) const
    {
        if (sink) sink({t, kind, text});
    }
    void skip(Time t, const std::string& kind, const std::string& text)
    {
        progress.skipped++;
        warn(t, kind, text + "; skipped");
    }

 public:
    RawlogConfig config;
    WarningSink sink;
    std::unique_ptr<EntrySource> reader;
    SensorChoice lidar, imu;
    StreamProgress progress;

 private:
    StampOrder order;
    std::map<std::size_t, CObservation::Ptr> ahead;  // by its id there
    std::deque<Judged> judged_already;               // up to the first with a good stamp
    std::size_t bytes_ahead = 0;
    std::size_t left_out = 0;    // by the reader, in progress.skipped already
    std::exception_ptr failure;  // of the reading: told when what was read before is given out
    std::optional<Pose> T_imu_vehicle;
    ImuUnitCheck unit_check;
    std::optional<Time> last_imu, last_scan, last_scan_end;
    Time begin = std::numeric_limits<Time>::min(), end = std::numeric_limits<Time>::max();
    std::optional<SweepCompleter> completer;  // once a scan without times was met
    bool finished = false;
};

/* ---- reading ---- */

/* Reads until the IMU's pose is known, which every scan needs, and far enough to find a second
 * sensor of a kind before any work was done. */
void RawlogSource::Impl::lookAhead()
{
    while (ahead.size() < kLookaheadCount && bytes_ahead < kLookaheadBytes &&
           order.elapsed() <= kLookahead && take())
    {
    }
    if (failure) std::rethrow_exception(failure);
    for (const auto& [id, observation] : ahead)
        if (const auto* o = dynamic_cast<const CObservationIMU*>(observation.get()))
            if (!T_imu_vehicle) setBody(*o);
    while (progress.now == 0)
    {
        auto judged = judge();
        if (!judged) break;
        judged_already.push_back(std::move(*judged));
    }
    progress.first = progress.now;
}

/* Takes the next observation of the chosen sensors in. False at the end. */
bool RawlogSource::Impl::take()
{
    if (failure) return false;
    std::optional<LogEntry> entry;
    try
    {
        entry = read();
    }
    catch (const std::exception&)
    {
        failure = std::current_exception();
        return false;
    }
    if (!entry) return false;
    const CObservation& observation = *entry->observation;
    SensorChoice& choice = isLidar(observation) ? lidar : imu;
    if (choice.chosen() != observation.sensorLabel) return true;
    if (!isValidStamp(observation.timestamp))
    {
        skip(
            progress.now, "no_stamp",
            "an observation of '" + observation.sensorLabel + "' has no time stamp");
        return true;
    }
    const auto id = order.push(
        isLidar(observation) ? StampOrder::Sensor::Lidar : StampOrder::Sensor::Imu,
        toTime(observation.timestamp));
    bytes_ahead += entry->bytes;
    ahead.emplace(id, std::move(entry->observation));
    return true;
}

/* The next one, by whose stamp progress.now goes on. */
std::optional<RawlogSource::Impl::Judged> RawlogSource::Impl::judge()
{
    while (!order.ready() && bytes_ahead < kLookaheadBytes && take())
    {
    }
    const auto stamp = order.pop();
    if (!stamp) return {};
    Judged judged{std::move(ahead.at(stamp->id)), *stamp};
    ahead.erase(stamp->id);
    if (ahead.empty()) bytes_ahead = 0;
    const Time t = toTime(judged.observation->timestamp) + stamp->shift;
    if (stamp->verdict != StampOrder::Verdict::Outlier)
        progress.now = progress.now == 0 ? t : std::max(progress.now, t);
    return judged;
}

/* The next observation of a LiDAR or an IMU; the others are counted alone. */
std::optional<LogEntry> RawlogSource::Impl::read()
{
    for (;;)
    {
        auto entry = reader->next();
        progress.bytes_read = reader->bytesRead();
        progress.bytes_total = reader->bytesTotal();
        progress.skipped += reader->leftOut() - left_out;
        left_out = reader->leftOut();
        if (entry) account(*entry);
        if (!entry || entry->observation) return entry;
    }
}

void RawlogSource::Impl::account(const LogEntry& entry)
{
    progress.sensors[{entry.label, entry.class_name}]++;
    if (!entry.observation) return;  // its stamps may be by another clock
    const CObservation& observation = *entry.observation;
    if (isLidar(observation))
        choose(lidar, entry.label, config.rig.lidar, progress.lidar_label);
    else
        choose(imu, entry.label, config.rig.imu, progress.imu_label);
}

/* The rig's part is dropped if it describes another sensor than the one chosen. */
template <class RigPart>
void RawlogSource::Impl::choose(
    SensorChoice& choice, const std::string& label, RigPart& rig, std::string& chosen_label)
{
    const bool is_first = !choice.chosen();
    if (!choice.accepts(label) || !is_first) return;
    chosen_label = label;
    if (NameExpression("the sensor label", rig.label).matches(label)) return;
    warn(
        0, "rig_unused",
        "the rig file describes '" + rig.label + "', not the sensor in use, '" + label + "'");
    rig = {};
}

void RawlogSource::Impl::setBody(const CObservationIMU& observation)
{
    progress.has_imu = true;
    const Pose T_vehicle_imu = toPose(observation.sensorPose);
    T_imu_vehicle = config.rig.imu.T_vehicle_imu.value_or(T_vehicle_imu).inverse();
}

std::optional<Measurement> RawlogSource::Impl::next()
{
    while (!finished)
    {
        std::optional<Judged> judged;
        if (judged_already.empty())
        {
            judged = judge();
        }
        else
        {
            judged = std::move(judged_already.front());
            judged_already.pop_front();
        }
        if (!judged)
        {
            finish();
            break;
        }
        if (auto measurement = convert(*judged)) return measurement;
    }
    return {};
}

void RawlogSource::Impl::finish()
{
    finished = true;
    progress.findings = reader->findings();
    if (failure) std::rethrow_exception(failure);
    if (!reader->damage().empty())
        warn(
            progress.now, "rawlog_truncated",
            "'" + config.path + "' cannot be read on after " +
                seconds(progress.now - progress.first) + " of log: " + reader->damage());
    if (!lidar.chosen())
    {
        std::string found;
        for (const auto& [sensor, observations] : progress.sensors)
            found += " '" + sensor.first + "' (" + std::to_string(observations) + " " +
                     sensor.second + ")";
        throw std::runtime_error(
            "no LiDAR " + std::string(lidar.byExpression() ? "of the label asked for " : "") +
            "in '" + config.path + "'; sensors there:" + (found.empty() ? " none" : found));
    }
    if (!imu.chosen() && imu.byExpression())
        warn(
            progress.now, "imu_not_found",
            "no IMU of the label asked for; labels of IMUs there: " + imu.describeSeen());
}

/* ---- conversion ---- */

std::optional<Measurement> RawlogSource::Impl::convert(const Judged& judged)
{
    const CObservation& observation = *judged.observation;
    const auto* as_imu = dynamic_cast<const CObservationIMU*>(&observation);
    const auto& [id, verdict, shift, amount] = judged.stamp;
    if (verdict != StampOrder::Verdict::Good)
    {
        const auto finding = findingOf(judged.stamp, as_imu ? "an IMU sample" : "a scan");
        if (verdict == StampOrder::Verdict::Outlier)
        {
            skip(progress.now, finding.kind, finding.text);
            return {};
        }
        warn(progress.now, finding.kind, finding.text);
    }
    if (beyondEnd(toTime(observation.timestamp) + shift))
    {
        finish();
        return {};
    }
    return as_imu ? convertImu(*as_imu, shift) : convertLidar(observation, shift);
}

std::optional<Measurement> RawlogSource::Impl::convertImu(
    const CObservationIMU& observation, Duration shift)
{
    using namespace mrpt::obs;
    ImuSample sample;
    sample.t = toTime(observation.timestamp) + shift;
    if (sample.t < begin) return {};
    if (!T_imu_vehicle)
    {
        setBody(observation);
        warn(
            sample.t, "imu_late",
            "the first IMU sample comes " + seconds(sample.t - progress.first) +
                " into the log; scans before it were placed relative to the vehicle");
    }
    constexpr TIMUDataIndex accel[] = {IMU_X_ACC, IMU_Y_ACC, IMU_Z_ACC};
    constexpr TIMUDataIndex gyro[] = {IMU_WX, IMU_WY, IMU_WZ};
    for (int i = 0; i < 3; i++)
    {
        if (!observation.has(accel[i]) || !observation.has(gyro[i]))
        {
            skip(sample.t, "imu_invalid", "an IMU sample lacks a rate or a specific force");
            return {};
        }
        sample.accel[i] = observation.get(accel[i]) * config.rig.imu.accel_scale;
        sample.gyro[i] = observation.get(gyro[i]) * config.rig.imu.gyro_scale;
    }
    if (!sample.accel.allFinite() || !sample.gyro.allFinite())
    {
        skip(sample.t, "imu_invalid", "an IMU sample has values that are not finite");
        return {};
    }
    if (!withinRange(sample)) return {};
    if (!checkImuTime(sample.t) || sample.t - kLongestScan > end) return {};
    if (const auto doubt = unit_check.add(sample)) warn(sample.t, "imu_units", *doubt);
    progress.imu_samples++;
    return sample;
}

bool RawlogSource::Impl::withinRange(const ImuSample& sample)
{
    const double accel = sample.accel.norm(), rate = sample.gyro.norm();
    const ImuRig& range = config.rig.imu;
    if (accel <= range.max_accel && rate <= range.max_rate) return true;
    skip(
        sample.t, "imu_outlier",
        format(
            "an IMU sample says %.3g m/s^2 and %.3g rad/s, beyond its range (max_accel %.4g, "
            "max_rate %.4g in the rig file)",
            accel, rate, range.max_accel, range.max_rate));
    return false;
}

bool RawlogSource::Impl::checkImuTime(Time t)
{
    if (last_imu && t <= *last_imu)
    {
        skip(
            t, t == *last_imu ? "imu_duplicate" : "imu_time",
            t == *last_imu ? "two IMU samples have the same stamp"
                           : "the IMU's time goes backward by " + seconds(*last_imu - t));
        return false;
    }
    last_imu = t;
    return true;
}

Pose RawlogSource::Impl::lidarPose(const CObservation& observation) const
{
    mrpt::poses::CPose3D pose;
    observation.getSensorPose(pose);
    const Pose T_vehicle_lidar = config.rig.lidar.T_vehicle_lidar.value_or(toPose(pose));
    return T_imu_vehicle ? *T_imu_vehicle * T_vehicle_lidar : T_vehicle_lidar;
}

std::optional<Measurement> RawlogSource::Impl::convertLidar(
    const CObservation& observation, Duration shift)
{
    const Duration clock_offset = fromSeconds(config.rig.lidar.clock_offset) + shift;
    const Time t = toTime(observation.timestamp) + clock_offset;
    if (t < begin || t > end || enoughScans()) return {};
    try
    {
        ScanBuilder points = observationToPoints(observation, config.rig.lidar);
        // A sweep ends before the next begins.
        const auto interval = order.interval(StampOrder::Sensor::Lidar);
        Scan scan = interval && *interval > 0 ? points.finish(*interval + kLargestOverlap)
                                              : points.finish();
        correctBeams(scan, config.rig.lidar.beams);
        progress.points += points.seen();
        progress.points_not_finite += points.notFinite();
        progress.points_bad_time += points.badTime() + points.outside();
        scan.stamp += clock_offset;
        scan.end += clock_offset;
        scan.sensor_label = observation.sensorLabel;
        scan.T_imu_lidar = lidarPose(observation);
        if (scan.points.empty())
        {
            skip(t, "scan_empty", "a scan has no valid point of " + std::to_string(points.seen()));
            return {};
        }
        if (scan.already_undistorted) completeTimes(scan);
        if (!checkScanTime(scan)) return {};
        checkPoints(points, t);
        progress.scans++;
        return scan;
    }
    catch (const std::exception& e)
    {
        skip(t, "scan_invalid", "a scan cannot be used: " + errorText(e));
        return {};
    }
}

/* What tells the times is learnt by reading the log a first time. */
void RawlogSource::Impl::learnTimes(Time t)
{
    completer.emplace(config.scan_times);
    bool any_sample = false;
    if (config.scan_times != ScanTimes::None) try
        {
            RawlogConfig again = config;
            again.scan_times = ScanTimes::None;
            RawlogSource source(again);
            while (auto measurement = source.next())
            {
                auto* scan = std::get_if<Scan>(&*measurement);
                any_sample |= scan == nullptr;
                if (scan == nullptr)
                    completer->learn(std::get<ImuSample>(*measurement));
                else if (!completer->learn(std::move(*scan)))
                    break;
            }
        }
        catch (const std::runtime_error&)
        {
            // Whatever ends the reading will do so here too, and is told then.
        }
    completer->finishLearning();
    // A rawlog cannot say that its sweeps are undistorted. Without an IMU they probably are, as
    // those of KITTI's odometry.
    if (config.scan_times == ScanTimes::Auto && !any_sample) completer.emplace(ScanTimes::None);
    const bool is_end = completer->stampIsEnd().value_or(false);
    completer->setStampIsEnd(is_end);
    const auto& found = completer->findings();
    warn(
        t, completer->interval() > 0 ? "scan_times" : "scan_undistorted",
        found.empty() ? "the points have no times, or all the same: taken as undistorted already"
                      : found.back() + (is_end ? "; stamps are those of the ends of sweeps" : ""));
}

void RawlogSource::Impl::completeTimes(Scan& scan)
{
    if (!completer) learnTimes(scan.stamp);
    if (completer->interval() > 0) completer->complete(scan);
}

bool RawlogSource::Impl::checkScanTime(const Scan& scan)
{
    const bool stamp_back = last_scan && scan.stamp <= *last_scan;
    const bool end_back = last_scan_end && scan.end <= *last_scan_end;
    if (stamp_back || end_back)
    {
        const Duration back = stamp_back ? *last_scan - scan.stamp : *last_scan_end - scan.end;
        const std::string what = stamp_back ? "stamp" : "end";
        skip(
            scan.stamp, back == 0 ? "scan_duplicate" : "scan_time",
            back == 0
                ? "two scans have the same " + what
                : "the LiDAR's time (" + what + " of the scan) goes backward by " + seconds(back));
        return false;
    }
    if (last_scan_end && scan.stamp < *last_scan_end - kLargestOverlap)
        warn(
            scan.stamp, "scan_overlap",
            "a scan begins " + seconds(*last_scan_end - scan.stamp) +
                " before the end of the one before: do the stamps come from another clock than "
                "the times of the points?");
    last_scan = scan.stamp;
    last_scan_end = scan.end;
    return true;
}

void RawlogSource::Impl::checkPoints(const ScanBuilder& points, Time t)
{
    if (points.outside() > 0)
        warn(
            t, "scan_point_times",
            std::to_string(points.outside()) + " points of " + std::to_string(points.seen()) +
                " have a time outside of their sweep; dropped");
    const std::size_t bad = points.notFinite() + points.badTime();
    if (static_cast<double>(bad) <= kWorstBadShare * static_cast<double>(points.seen())) return;
    warn(
        t, "scan_bad_points",
        std::to_string(points.notFinite()) + " points of " + std::to_string(points.seen()) +
            " are not finite and " + std::to_string(points.badTime()) +
            " have a time 2 s or more away from the scan's; dropped");
}

bool RawlogSource::Impl::enoughScans() const
{
    return config.only_first_n > 0 &&
           progress.scans >= static_cast<std::size_t>(config.only_first_n);
}

/* The IMU is read on until it covers the last scan. */
bool RawlogSource::Impl::beyondEnd(Time t) const
{
    if (!enoughScans())
        return end < std::numeric_limits<Time>::max() - kDisorder && t > end + kDisorder;
    return !last_scan_end || (last_imu && *last_imu >= *last_scan_end) ||
           t > *last_scan_end + kDisorder;
}

RawlogSource::RawlogSource(const RawlogConfig& config, WarningSink warn)
    : impl_(std::make_unique<Impl>(config, std::move(warn)))
{
}
RawlogSource::~RawlogSource() = default;

std::optional<Measurement> RawlogSource::next()
{
    return impl_->next();
}

StreamProgress RawlogSource::progress() const
{
    return impl_->progress;
}

bool RawlogSource::incomplete() const
{
    return !impl_->reader->damage().empty();
}
}  // namespace taut
