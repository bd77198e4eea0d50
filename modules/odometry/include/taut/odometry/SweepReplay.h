#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "taut/core/Measurement.h"
#include "taut/factors/Sweep.h"
#include "taut/odometry/OdometryConfig.h"

namespace taut
{
class Synchronizer;

/** What a sweep was undistorted with, without its points and samples: they come again. */
struct SweepRecord
{
    explicit SweepRecord(const Sweep& sweep, const NavState& final_end);

    Undistortion mode;
    bool with_imu;
    Vector3d previous_rate;
    ImuNoise noise;
    NavState prior_begin, prior_end, begin, end;  //!< as of Sweep; `end` is final
};

/** Puts the sweeps of a recording together again while it is streamed a second time, each with the
 * states that are asked for: for points along a corrected path. Not thread-safe. */
class SweepReplay
{
 public:
    /** The record of the next sweep, in the order of time; nothing: no more are wanted. */
    using Records = std::function<std::optional<SweepRecord>()>;

    /** `config`: as in the first pass. `sink` gets each sweep. */
    SweepReplay(
        const OdometryConfig& config, Records records, std::function<void(const Sweep&)> sink);
    ~SweepReplay();
    SweepReplay(const SweepReplay&) = delete;
    SweepReplay& operator=(const SweepReplay&) = delete;

    /** The measurements of the first pass, in the same order. */
    void add(Measurement measurement);
    /** No more data. */
    void finish();

    std::size_t sweeps() const { return sweeps_; }  //!< given to the sink

 private:
    void advance();
    void replay(const Scan& scan);

    OdometryConfig config_;
    Records records_;
    std::function<void(const Sweep&)> sink_;
    std::unique_ptr<Synchronizer> streams_;
    std::unique_ptr<Preintegrator> preintegrator_, fallback_preintegrator_;
    std::optional<SweepRecord> next_;
    std::size_t sweeps_ = 0;
};
}  // namespace taut
