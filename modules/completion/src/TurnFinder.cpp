#include "taut/completion/TurnFinder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "SeamFinder.h"
#include "StampJudge.h"
#include "SweepOrder.h"
#include "taut/core/ImuUnits.h"
#include "taut/core/format.h"

namespace taut
{
namespace
{
constexpr double kTurn = 2 * M_PI;
constexpr std::size_t kFewestSweeps = 3, kSweepsForOrder = 10, kMostSweeps = 3000;
constexpr std::size_t kSweepsToAsk = 20, kMostForStamps = 600;
constexpr double kAgreeing = 0.8;                                    // of the sweeps
constexpr Duration kShortest = 2'000'000, kLongest = 2'000'000'000;  // a sweep takes [ns]
constexpr double kSameBegin = 0.17;      // [rad] between those of most sweeps
constexpr double kLeastStagger = 0.005;  // [rad]; less is no error worth a thought
constexpr double kLeastView = 0.5;       // of a turn
constexpr double kSortedFrom = 0.02;  // [rad] around 0 and 180 deg, where sorting by angle begins
constexpr double kOtherPlace = 0.17;  // [rad] between what order and motion tell

template <class T>
T quantile(std::vector<T> values, double share)
{
    const auto at = values.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/** How far a sensor looks around, as a share of a turn. */
double viewOf(const Scan& scan)
{
    constexpr int kSectors = 72;
    std::array<bool, kSectors> seen{};
    for (const LidarPoint& point : scan.points)
    {
        const double turn = azimuthOf(point) / kTurn + 0.5;
        seen[static_cast<std::size_t>(
            std::clamp(static_cast<int>(turn * kSectors), 0, kSectors - 1))] = true;
    }
    return static_cast<double>(std::count(seen.begin(), seen.end(), true)) / kSectors;
}

/** By how much the lasers of each ring look aside of those fired with them: sums over sweeps whose
 * points are in the order of time. */
class StaggerSums
{
 public:
    void add(const Scan& scan)
    {
        if (scan.rings < 2) return;
        const auto rings = static_cast<std::size_t>(scan.rings);
        sums_.resize(std::max(sums_.size(), rings));
        counts_.resize(sums_.size());
        std::vector<std::complex<double>> until{0};
        for (const LidarPoint& point : scan.points)
            until.push_back(until.back() + std::polar(1.0, azimuthOf(point)));
        for (std::size_t i = rings; i + rings < scan.points.size(); i++)
        {
            const double head = std::arg(until[i + rings + 1] - until[i - rings]);
            const auto ring = std::min<std::size_t>(scan.points[i].ring, sums_.size() - 1);
            sums_[ring] += wrapped(azimuthOf(scan.points[i]) - head);
            counts_[ring]++;
        }
    }

    /** Empty if all look the same way. */
    std::vector<double> stagger() const
    {
        if (sums_.empty()) return {};
        std::vector<double> means;
        for (std::size_t r = 0; r < sums_.size(); r++)
            means.push_back(counts_[r] > 0 ? sums_[r] / counts_[r] : 0);
        const double largest = *std::max_element(
            means.begin(), means.end(),
            [](double a, double b) { return std::abs(a) < std::abs(b); });
        if (std::abs(largest) < kLeastStagger) return {};
        return means;
    }

 private:
    std::vector<double> sums_, counts_;
};
}  // namespace

struct TurnFinder::Learnt
{
    std::vector<Time> stamps;
    std::vector<SweepOrder> orders;  // without the points' own
    StaggerSums stagger;
    std::unique_ptr<Panorama> last;  // of the sweep before
    SeamFinder seam;
    StampJudge stamps_judge;
    double widest_view = 0;
    std::size_t after_seam = 0;  // sweeps

    /** The order that most sweeps have. */
    PointOrder order() const
    {
        for (const PointOrder kind : {PointOrder::InTime, PointOrder::LaserByLaser})
        {
            double count = 0, sense = 0;
            for (const SweepOrder& order : orders)
                if (order.kind == kind)
                {
                    count++;
                    sense += order.sense;
                }
            const double enough = kAgreeing * static_cast<double>(orders.size());
            if (count >= enough && std::abs(sense) >= enough) return kind;
        }
        return PointOrder::None;
    }

    Duration interval() const
    {
        std::vector<Duration> intervals;
        for (std::size_t i = 1; i < stamps.size(); i++)
            intervals.push_back(stamps[i] - stamps[i - 1]);
        return intervals.empty() ? 0 : quantile(std::move(intervals), 0.5);
    }
};

TurnFinder::TurnFinder(ScanTimes asked) : asked_(asked), learnt_(std::make_unique<Learnt>()) {}
TurnFinder::~TurnFinder() = default;
TurnFinder::TurnFinder(TurnFinder&&) noexcept = default;
TurnFinder& TurnFinder::operator=(TurnFinder&&) noexcept = default;

bool TurnFinder::learn(const Scan& scan)
{
    if (asked_ == ScanTimes::None) return false;
    Learnt& l = *learnt_;
    l.stamps.push_back(scan.stamp);
    SweepOrder order = orderOf(scan);
    if (order.kind == PointOrder::InTime && l.orders.size() < kSweepsForOrder) l.stagger.add(scan);
    order.turned.clear();
    l.orders.push_back(std::move(order));
    l.widest_view = std::max(l.widest_view, viewOf(scan));
    auto panorama = std::make_unique<Panorama>(scan);
    if (l.last)
    {
        l.seam.add(*l.last, *panorama);
        l.stamps_judge.add(l.stamps[l.stamps.size() - 2], scan.stamp, *l.last, *panorama);
    }
    l.last = std::move(panorama);
    if (l.orders.size() < kSweepsForOrder) return true;
    if (l.widest_view < kLeastView || l.orders.size() >= kMostSweeps) return false;
    if (!l.seam.decided()) return true;
    if (!l.stamps_judge.hasSamples()) return false;
    // What motion there was may be too little to tell what stamps are.
    l.after_seam++;
    if (l.after_seam % kSweepsToAsk == 1 && l.stamps_judge.isEnd(l.interval())) return false;
    return l.after_seam < kMostForStamps;
}

void TurnFinder::learn(const ImuSample& sample)
{
    if (asked_ != ScanTimes::None) learnt_->stamps_judge.add(sample);
}

bool TurnFinder::refuse(const std::string& why)
{
    finding_ =
        "the points have no times: the sweeps are taken as already undistorted, as measured "
        "at their stamp (" +
        why + "); if they are not, record them with a time for each point";
    interval_ = period_ = 0;
    return false;
}

bool TurnFinder::finishLearning()
{
    if (asked_ == ScanTimes::None) return refuse("as asked for");
    const Learnt& l = *learnt_;
    if (l.orders.size() < kFewestSweeps) return refuse("there are too few sweeps to judge by");
    if (l.widest_view < kLeastView) return refuse("no sensor that turns all around");
    interval_ = period_ = l.interval();
    if (interval_ < kShortest || interval_ > kLongest)
        return refuse("their stamps are no sweep's duration apart");
    bool told = false;
    const PointOrder order = l.order();
    if (order != PointOrder::None)
        told = tellByOrder();
    else if (l.seam.seam())
        told = tellByMotion("no order tells them, but sweeps in motion do not fit together there");
    else if (l.seam.fitsEverywhere())
        return refuse("in motion, their points fit together everywhere");
    else
        return refuse("neither an order of the points nor motion tells how the sensor turns");
    if (told) stamp_is_end_ = l.stamps_judge.isEnd(interval_);
    learnt_.reset();
    return told;
}

bool TurnFinder::tellByOrder()
{
    const Learnt& l = *learnt_;
    const PointOrder kind = l.order();
    double sense = 0;
    std::complex<double> sum = 0;
    for (const SweepOrder& order : l.orders)
    {
        if (order.kind != kind) continue;
        sense += order.sense;
        sum += std::polar(1.0, order.first);
    }
    sense_ = sense < 0 ? -1 : 1;
    const double usual = std::arg(sum);
    std::vector<double> late, steps;
    for (std::size_t i = 0; i < l.orders.size(); i++)
    {
        if (l.orders[i].kind != kind) continue;
        late.push_back(sense_ * wrapped(l.orders[i].first - usual));
        if (i > 0) steps.push_back(sense_ * wrapped(l.orders[i].first - l.orders[i - 1].first));
    }
    // The first returns of a sweep may be missing: it began as early as any, but for strays.
    const double earliest = quantile(late, 0.1);
    own_begin_ = quantile(late, 0.9) - earliest > kSameBegin;
    first_ = wrapped(usual + sense_ * earliest);
    stagger_ = l.stagger.stagger();
    if (own_begin_)
    {
        const double goes_on = kTurn + quantile(std::move(steps), 0.5);
        period_ = std::llround(static_cast<double>(interval_) * kTurn / goes_on);
        say("the order of the points");
        return true;
    }
    if (asked_ == ScanTimes::Auto && l.seam.fitsEverywhere())
        return refuse("in motion, their points fit together where a turn begins");
    const auto seam = l.seam.seam();
    // In the order of time there is nothing to doubt; the points of lasers may have been sorted.
    if (kind == PointOrder::LaserByLaser && seam &&
        (seam->sense != sense_ || std::abs(wrapped(seam->azimuth - first_)) > kOtherPlace))
        return tellByMotion("not by the order of the points, which motion contradicts");
    const bool is_sorted = kind == PointOrder::LaserByLaser && sense_ > 0 &&
                           std::abs(std::remainder(first_, M_PI)) < kSortedFrom;
    if (is_sorted && !seam && asked_ == ScanTimes::Auto)
        return refuse(
            "their points are sorted by azimuth, and motion does not tell how the sensor turns; "
            "--scan-times azimuth takes them as measured in that order");
    say(kind == PointOrder::InTime ? "the order of the points"
                                   : "the order of each laser's points");
    return true;
}

bool TurnFinder::tellByMotion(const std::string& how)
{
    const auto seam = learnt_->seam.seam();
    sense_ = seam->sense;
    first_ = seam->azimuth;
    by_motion_ = true;
    say("motion: " + how);
    return true;
}

void TurnFinder::say(const std::string& how)
{
    finding_ = std::string("times of the points: from their azimuth, ") +
               (sense_ < 0 ? "clockwise" : "counter-clockwise") + " from above" +
               (own_begin_ ? ", each sweep from its first point on"
                           : format(", from %.1f deg on", first_ / kDegree)) +
               format(", a turn of %.2f ms", 1e-6 * static_cast<double>(period_)) + " (by " + how +
               ")";
    if (!stagger_.empty()) finding_ += "; lasers that look aside are taken into account";
}

Duration TurnFinder::interval() const
{
    return interval_;
}

void TurnFinder::apply(Scan& scan, bool stamp_is_end) const
{
    if (period_ == 0 || scan.points.size() < 2) return;
    SweepOrder order = orderOf(scan, stagger_);
    const bool ordered = !by_motion_ && order.kind != PointOrder::None && order.sense == sense_ &&
                         (own_begin_ || std::abs(wrapped(order.first - first_)) < kTurn / 4);
    if (!ordered && own_begin_) return;
    std::vector<Duration> offsets;
    for (std::size_t i = 0; i < scan.points.size(); i++)
    {
        double turned = 0;
        if (ordered)
            turned = order.turned[i] + (own_begin_ ? 0 : sense_ * wrapped(order.first - first_));
        else
        {
            turned = sense_ * (azimuthOf(scan.points[i]) - first_);
            turned -= kTurn * std::floor(turned / kTurn);
        }
        offsets.push_back(std::llround(turned / kTurn * static_cast<double>(period_)));
    }
    const auto [least, most] = std::minmax_element(offsets.begin(), offsets.end());
    const Duration first = *least, last = *most;
    for (std::size_t i = 0; i < scan.points.size(); i++)
        scan.points[i].offset = static_cast<std::int32_t>(offsets[i] - first);
    scan.stamp += first - (stamp_is_end ? interval_ : 0);
    scan.end = scan.stamp + last - first;
    scan.already_undistorted = false;
}
}  // namespace taut
