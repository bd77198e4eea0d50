#include "taut/odometry/SweepReplay.h"

#include "Synchronizer.h"

namespace taut
{
SweepRecord::SweepRecord(const Sweep& sweep, const NavState& final_end)
    : mode(sweep.mode),
      with_imu(sweep.with_imu),
      previous_rate(sweep.previous_rate),
      noise(sweep.noise),
      prior_begin(sweep.prior_begin),
      prior_end(sweep.prior_end),
      begin(sweep.begin),
      end(final_end)
{
}

SweepReplay::SweepReplay(
    const OdometryConfig& config, Records records, std::function<void(const Sweep&)> sink)
    : config_(config),
      records_(std::move(records)),
      sink_(std::move(sink)),
      streams_(std::make_unique<Synchronizer>(config.imu_wait, config.imu_range, WarningSink{})),
      preintegrator_(config.preintegrator.create()),
      fallback_preintegrator_(config.fallback_preintegrator.create()),
      next_(records_())
{
    if (!config_.preintegrator->needsImu()) streams_->runWithoutImu();
}

SweepReplay::~SweepReplay() = default;

void SweepReplay::add(Measurement measurement)
{
    if (!next_) return;
    if (const auto* sample = std::get_if<ImuSample>(&measurement))
    {
        if (config_.preintegrator->needsImu()) streams_->add(*sample);
    }
    else
    {
        streams_->add(std::move(std::get<Scan>(measurement)));
    }
    advance();
}

void SweepReplay::finish()
{
    streams_->end();
    advance();
}

void SweepReplay::advance()
{
    while (next_ && streams_->ready() > 0)
    {
        const Scan& scan = streams_->scans().front();
        while (next_ && next_->end.t < scan.end) next_ = records_();
        if (next_ && next_->end.t == scan.end)
        {
            replay(scan);
            next_ = records_();
        }
        streams_->popScan();
        if (next_) streams_->forgetSamplesBefore(next_->begin.t);
    }
}

void SweepReplay::replay(const Scan& scan)
{
    Sweep sweep;
    sweep.mode = next_->mode;
    sweep.with_imu = next_->with_imu;
    sweep.T_imu_lidar = scan.T_imu_lidar;
    sweep.previous_rate = next_->previous_rate;
    sweep.noise = next_->noise;
    sweep.prior_begin = next_->prior_begin;
    sweep.prior_end = next_->prior_end;
    sweep.begin = next_->begin;
    sweep.end = next_->end;
    sweep.scan = thinned(
        transformScan(scan, config_.range, sweep.begin.t),
        static_cast<std::size_t>(config_.insert.max_points));

    PreintegrationRequest request;
    request.begin = sweep.begin.t;
    request.end = scan.end;
    request.samples = sweep.with_imu ? &streams_->samples() : nullptr;
    request.previous = sweep.prior_begin;
    request.previous_rate = sweep.previous_rate;
    request.noise = sweep.noise;
    sweep.motion = (sweep.with_imu ? preintegrator_ : fallback_preintegrator_)->integrate(request);
    sweeps_++;
    sink_(sweep);
}
}  // namespace taut
