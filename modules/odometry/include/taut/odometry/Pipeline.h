#pragma once

#include <deque>
#include <functional>
#include <memory>

#include "taut/odometry/Odometry.h"

namespace taut
{
struct TriedStart;

/** Brings the streams together: waits for the initialisation, holds each scan until the IMU reaches
 * over its end, and hands both to the odometry. */
class Pipeline
{
 public:
    using ResultSink = std::function<void(const Scan&, const ScanResult&)>;

    Pipeline(
        const OdometryConfig& config, Executor& executor, const WarningSink& warn,
        ResultSink results);

    void add(const ImuSample& sample);
    void add(Scan scan);

    /** No more data: processes what was held back. */
    void finish();

    bool withImu() const { return mode_ != Mode::WithoutImu; }
    const std::optional<Initialization>& initialization() const { return initialization_; }

 private:
    enum class Mode
    {
        Undecided,  //!< no IMU sample and not enough scans yet
        WithImu,
        WithoutImu,
    };

    void begin(const Initialization& initialization);
    void beginWithoutImu();
    void processReady(bool all);
    std::size_t readyScans() const;
    void bootstrap();
    TriedStart settle(const Initialization& initialization);
    std::vector<ScanResult> tryStart(const Initialization& start);
    void process(const Scan& scan);

    const OdometryConfig& config_;
    WarningSink warn_;
    ResultSink results_;
    Odometry odometry_;
    Initializer initializer_;
    std::optional<Initialization> initialization_;
    Mode mode_ = Mode::Undecided;
    bool bootstrapped_ = false;
    std::deque<Scan> waiting_;
    ImuSamples imu_;
};
}  // namespace taut
