#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/Imu.h"
#include "taut/core/Scan.h"

namespace taut
{
/** Where the times of points come from in sweeps whose recording does not tell them. */
enum class ScanTimes
{
    Auto,     //!< the azimuth, if the sensor turns and nobody undistorted the sweeps
    Azimuth,  //!< the azimuth, if the sensor turns
    None      //!< nowhere: the sweeps are taken as undistorted already
};

/** Tells when a turning LiDAR measured its points, in sweeps whose recording does not say: the time
 * is the azimuth's share of a turn.
 *
 * Way and begin of the turn are told by the order of the points: as they were measured, or one
 * laser after the other. Where there is no order, motion tells them: sweeps do not fit together at
 * the azimuth where they begin and end (SeamFinder). The period is that of the stamps, less or more
 * what the begin goes on from sweep to sweep. Lasers that look aside of the others are taken into
 * account if the rings are known.
 *
 * If, while the sensor moves, sweeps fit together everywhere, somebody undistorted them. */
class TurnFinder
{
 public:
    explicit TurnFinder(ScanTimes asked = ScanTimes::Auto);
    ~TurnFinder();
    TurnFinder(TurnFinder&&) noexcept;
    TurnFinder& operator=(TurnFinder&&) noexcept;

    /** A sweep of the beginning, in the order of time, with its points in that of the recording.
     * False if no more are needed: at the latest after some minutes. */
    bool learn(const Scan& scan);

    /** A sample of the IMU among them, as it is. */
    void learn(const ImuSample& sample);

    /** Judges what was learnt. True if times can be told. */
    bool finishLearning();

    /** From one sweep's begin to the next one's [ns]; 0 if finishLearning() was not true. */
    Duration interval() const;

    /** Whether the stamps are the ends of the sweeps (true) or their begins: by when the gyro
     * turned as the view of the sensor did. Nothing if motion does not tell. */
    std::optional<bool> stampIsEnd() const { return stamp_is_end_; }

    /** Sets the times of the points, Scan::stamp to the first of them and Scan::end to the last.
     * `stamp_is_end`: the stamp is the time of the end of the sweep, not of its begin. A sweep that
     * is not like those learnt stays as it is. */
    void apply(Scan& scan, bool stamp_is_end) const;

    /** What was found and how, or why nothing: a line for a summary. */
    const std::string& finding() const { return finding_; }

 private:
    struct Learnt;
    bool refuse(const std::string& why);
    bool tellByOrder();
    bool tellByMotion(const std::string& how);
    void say(const std::string& how);

    ScanTimes asked_;
    std::unique_ptr<Learnt> learnt_;
    double sense_ = 1;        // +1 if the azimuth grows with time
    bool by_motion_ = false;  // the order of the points tells nothing
    bool own_begin_ = false;  // each sweep begins where its first point is
    double first_ = 0;        // [rad] azimuth where all begin, if not so
    Duration period_ = 0;     // of a whole turn
    Duration interval_ = 0;   // of the sweeps
    std::optional<bool> stamp_is_end_;
    std::vector<double> stagger_;  // of each ring [rad]
    std::string finding_ = "times of the points: not looked for";
};
}  // namespace taut
