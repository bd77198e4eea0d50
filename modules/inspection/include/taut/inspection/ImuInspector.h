#pragma once

#include <array>
#include <optional>
#include <string>

#include "taut/core/ImuUnits.h"
#include "taut/inspection/Finding.h"
#include "taut/inspection/IntervalStatistics.h"
#include "taut/preintegration/Initializer.h"

namespace taut
{
/** Of a common MEMS IMU: the estimation takes the noise that it sees at rest, a finding is worth
 * only one that is out of the ordinary. */
inline constexpr ImuNoise kOrdinaryNoise{2e-3, 2e-2, 1e-4, 1e-3};

/** What an IMU's samples tell by themselves. */
struct ImuFacts
{
    std::size_t samples = 0;
    Time first = 0, last = 0;
    double rate = 0;        //!< [Hz] by the median interval
    Unit accel_unit;        //!< judged from gravity in the first second
    Unit gyro_unit;         //!< rad/s unless a rate is too high for it, or the LiDAR disagrees
    double max_gyro = 0;    //!< largest component, in SI
    double max_accel = 0;   //!< the same of the specific force
    double mean_force = 0;  //!< [m/s^2] norm, over the first second
    double rest = 0;        //!< [s] at the start
    ImuNoise noise;         //!< at rest, white noise only; 0 without a rest
    Vector3d bias_gyro = Vector3d::Zero();  //!< at rest [rad/s]
    double force_at_rest = 0;               //!< [m/s^2] norm of the mean specific force
};

/** Looks at the samples of an IMU as they pass by; memory is bounded by one second of them. */
class ImuInspector
{
 public:
    ImuInspector();

    /** Samples strictly increasing in time, as RawlogSource gives them. */
    void add(const ImuSample& sample);

    /** No more samples. */
    void finish();

    /** After finish(). `gyro_in_degrees`: what the LiDAR says of the gyro's unit, where it says
     * something. */
    ImuFacts facts(std::optional<bool> gyro_in_degrees = {}) const;

    /** Gaps, jitter, clipping, units, rest and noise, against the noise that is expected. */
    Findings findings(const ImuFacts& facts, const ImuNoise& expected) const;

 private:
    /** How often the largest value of an axis was repeated exactly. */
    struct Extreme
    {
        double value = 0;
        std::size_t count = 0;
        Time first = 0;
        void add(double v, Time t);
    };
    using Extremes = std::array<Extreme, 6>;  // up and down of each axis
    static void add(Extremes& extremes, const Vector3d& v, Time t);
    static double largest(const Extremes& extremes);

    void startRest();
    void addToRest(const ImuSample& sample);
    void addTiming(const ImuFacts& facts, Findings& findings) const;
    void addUnits(const ImuFacts& facts, Findings& findings) const;
    static void addClipping(
        const Extremes& extremes, const std::string& sensor, double factor, double smallest,
        const std::string& unit, Findings& findings);
    void addRest(const ImuFacts& facts, const ImuNoise& expected, Findings& findings) const;

    std::size_t samples_ = 0;
    Time first_ = 0, last_ = 0;
    IntervalStatistics intervals_;
    Extremes gyro_extremes_, accel_extremes_;
    ImuSamples first_second_;
    bool rest_started_ = false;
    ImuUnitJudge unit_judge_;
    double mean_force_ = 0;  // as recorded
    Unit accel_unit_{"m/s^2", 1};
    Initializer rest_rad_, rest_deg_;  // by the unit that the gyro may have
};
}  // namespace taut
