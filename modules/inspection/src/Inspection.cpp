#include "taut/inspection/Inspection.h"

#include <algorithm>
#include <cmath>

#include "LogFindings.h"
#include "taut/core/format.h"
#include "taut/inspection/TurningWindow.h"
#include "taut/rawlog/PrefetchedRawlog.h"

namespace taut
{
namespace
{
constexpr double kShareOfReading = 0.3;      // of the work, for the progress
constexpr double kMargin = 1.0;              // [s] of IMU around the window
constexpr std::size_t kMostPoints = 12'000;  // of a scan to be matched
constexpr std::size_t kMostScans = 400;      // of the window
constexpr double kSmallestWindow = 3;        // [s]
constexpr double kUncovered = 0.5;           // [s] of scans without IMU at either end

/** A scan of at most kMostPoints, taken evenly but in no step with rings and columns. */
Scan thinned(Scan scan)
{
    const double share = static_cast<double>(kMostPoints) / static_cast<double>(scan.points.size());
    if (share >= 1) return scan;
    constexpr double kGolden = 0.6180339887498949;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < scan.points.size(); i++)
        if (std::fmod(static_cast<double>(i) * kGolden, 1.0) < share)
            scan.points[kept++] = scan.points[i];
    scan.points.resize(kept);
    scan.points.shrink_to_fit();
    return scan;
}

class Inspector
{
 public:
    Inspector(
        const InspectionConfig& config, Executor& executor,
        const std::function<void(double, std::size_t, double)>& progress)
        : config_(config), executor_(executor), progress_(progress), turning_(config.window)
    {
    }

    Inspection run()
    {
        read();
        imu_.finish();
        if (lidar_.facts().scans > 0) result_.lidar = lidar_.facts();
        if (result_.log.imu_samples > 0) result_.imu = imu_.facts();
        if (config_.match_scans && result_.lidar && result_.imu) compare();
        collect();
        return std::move(result_);
    }

 private:
    void read()
    {
        PrefetchedRawlog log(config_.log, [this](const Warning& w) { warnings_.add(w); });
        try
        {
            while (const auto m = log.next())
            {
                if (const auto* sample = std::get_if<ImuSample>(&*m))
                {
                    imu_.add(*sample);
                    turning_.add(*sample);
                }
                else
                {
                    lidar_.add(std::get<Scan>(*m));
                }
                result_.log = log.progress();
                warnings_.watch(result_.log);
                report(kShareOfReading * result_.log.fraction());
            }
        }
        catch (const std::exception& e)
        {
            result_.log = log.progress();
            if (result_.log.scans + result_.log.imu_samples == 0) throw;
            addFinding("unreadable", e.what(), "see the text; what was read before is judged");
        }
        result_.log = log.progress();
        result_.incomplete = log.incomplete();
    }

    void report(double share) const
    {
        if (progress_)
            progress_(share, result_.log.scans, toSeconds(result_.log.now - result_.log.first));
    }

    void addFinding(const std::string& kind, const std::string& text, const std::string& advice)
    {
        result_.findings.push_back({0, kind, 0, "", 1, text, advice});
    }

    /** Reads the window with the most turning once more and matches its scans. */
    void compare()
    {
        RotationFacts facts;
        const auto window = turning_.best();
        const bool apart = overlap() <= 0;
        if (result_.lidar->undistorted == result_.lidar->scans)
            facts.not_estimated = "the scans are undistorted already: their time is not known";
        else if (apart || !window || toSeconds(window->end - window->begin) < kSmallestWindow)
            facts.not_estimated = "there are no 3 s of scans and IMU samples without a gap";
        if (!facts.not_estimated.empty())
        {
            result_.rotation = facts;
            return;
        }
        std::vector<Scan> scans;
        ImuSamples samples;
        readWindow(window->begin, window->end, scans, samples);
        result_.rotation = compareRotations(
            scans, samples, executor_,
            [this](double share) { report(kShareOfReading + (1 - kShareOfReading) * share); });
        result_.rotation->applied_offset = config_.log.rig.lidar.clock_offset;
        if (result_.rotation->not_estimated.empty())
            result_.imu = imu_.facts(result_.rotation->gyro_factor != 1);
    }

    void readWindow(Time begin, Time end, std::vector<Scan>& scans, ImuSamples& samples) const
    {
        RawlogConfig part = config_.log;
        part.only_first_n = 0;
        part.from_time = std::max(part.from_time, toSeconds(begin - result_.log.first) - kMargin);
        part.to_time = std::min(part.to_time, toSeconds(end - result_.log.first));
        PrefetchedRawlog log(part);
        try
        {
            while (auto m = log.next())
            {
                if (const auto* sample = std::get_if<ImuSample>(&*m))
                    samples.push_back(*sample);
                else if (Scan& scan = std::get<Scan>(*m);
                         scan.stamp >= begin && scans.size() < kMostScans)
                    scans.push_back(thinned(std::move(scan)));
            }
        }
        catch (const std::exception&)
        {
            // Reported when the whole was read; what came before is matched.
        }
    }

    /** [s] that both sensors cover; negative: how far they are apart. */
    double overlap() const
    {
        const LidarFacts& l = *result_.lidar;
        const ImuFacts& i = *result_.imu;
        return toSeconds(std::min(l.end, i.last) - std::max(l.begin, i.first));
    }

    void collect()
    {
        const auto append = [this](Findings found)
        {
            for (Finding& f : found) result_.findings.push_back(std::move(f));
        };
        const bool own_units =
            result_.imu && (result_.imu->accel_unit.factor != 1 ||
                            result_.imu->gyro_unit.factor != 1 || !result_.imu->accel_unit.known());
        append(warnings_.findings(result_.log, own_units));
        if (result_.lidar) append(lidar_.findings(*result_.lidar));
        if (result_.imu)
            append(imu_.findings(*result_.imu, config_.log.rig.imu.noise.value_or(kOrdinaryNoise)));
        addCoverage();
        if (result_.rotation) append(findingsOf(*result_.rotation));
        std::stable_sort(
            result_.findings.begin(), result_.findings.end(),
            [](const Finding& a, const Finding& b) { return a.t < b.t; });
    }

    void addCoverage()
    {
        if (!result_.imu)
        {
            if (config_.log.imu_label.empty())
                addFinding(
                    "no_imu", "no IMU sample could be read",
                    "record an IMU; without, a constant velocity is assumed within a sweep");
            return;
        }
        if (!result_.lidar) return;
        const LidarFacts& l = *result_.lidar;
        const ImuFacts& i = *result_.imu;
        const double apart = -overlap();
        if (apart >= 0)
        {
            result_.findings.push_back(
                {l.begin, "clocks_apart", toSeconds(i.first - l.begin), "s", 1,
                 format(
                     "LiDAR and IMU share no time: the IMU begins %.3f s after the LiDAR",
                     toSeconds(i.first - l.begin)),
                 "they are stamped by different clocks: use one, or set lidar.clock_offset in the "
                 "rig file"});
            return;
        }
        const double late = toSeconds(i.first - l.begin), early = toSeconds(l.end - i.last);
        const double uncovered = std::max(late, early);
        if (uncovered > kUncovered)
            result_.findings.push_back(
                {late > early ? l.begin : i.last, "imu_coverage", uncovered, "s", 1,
                 format(
                     "the first %.2f s and the last %.2f s of the scans are without IMU",
                     std::max(0.0, late), std::max(0.0, early)),
                 "cut them off with --from-time and --to-time"});
    }

    const InspectionConfig& config_;
    Executor& executor_;
    const std::function<void(double, std::size_t, double)>& progress_;
    Inspection result_;
    LogFindings warnings_;
    ImuInspector imu_;
    LidarInspector lidar_;
    TurningWindow turning_;
};
}  // namespace

Inspection inspectRecording(
    const InspectionConfig& config, Executor& executor,
    const std::function<void(double, std::size_t, double)>& progress)
{
    return Inspector(config, executor, progress).run();
}
}  // namespace taut
