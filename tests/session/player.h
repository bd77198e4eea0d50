#pragma once

#include <optional>
#include <stdexcept>
#include <vector>

#include "taut/core/Measurement.h"

namespace taut::test
{
/** Measurements out of memory, in the order of time. */
class Player : public MeasurementStream
{
 public:
    Player(const ImuSamples& imu, const std::vector<Scan>& scans)
    {
        auto sample = imu.begin();
        for (const Scan& scan : scans)
        {
            for (; sample != imu.end() && sample->t <= scan.end; ++sample)
                all_.emplace_back(*sample);
            all_.emplace_back(scan);
        }
        for (; sample != imu.end(); ++sample) all_.emplace_back(*sample);
    }

    std::optional<Measurement> next() override
    {
        if (at_ == throws_at) throw std::runtime_error("the cable was cut");
        if (at_ == all_.size()) return std::nullopt;
        return all_[at_++];
    }
    StreamProgress progress() const override
    {
        StreamProgress p;
        p.bytes_read = at_;
        p.bytes_total = all_.size();
        return p;
    }
    bool incomplete() const override { return false; }

    std::size_t throws_at = static_cast<std::size_t>(-1);
    std::size_t size() const { return all_.size(); }

 private:
    std::vector<Measurement> all_;
    std::size_t at_ = 0;
};
}  // namespace taut::test
