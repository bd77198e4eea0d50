#include "taut/calibration/BeamCalibrator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include "taut/odometry/Pipeline.h"
#include "taut/odometry/registerAll.h"
#include "taut/simulation/Simulator.h"

using namespace taut;
using namespace taut::simulation;

namespace
{
/** A walk with a LiDAR whose beams err, and what is found of their errors. */
class TheBeams : public ::testing::Test
{
 protected:
    void walk(const std::string& world, double seconds)
    {
        ConfigSection section(parseYaml(
            "duration: " + std::to_string(seconds) + "\nrest: 3\nworld: {type: " + world +
            "}\nmotion: {type: walk}\nimu: {type: industrial}\n"
            "lidar: {type: VLP-16, beam_error: 0.0017, beam_range_error: 0.02}\n"));
        simulator.emplace(readScenario(section));
        for (int k = 0; k < simulator->sweeps(); k++)
            scans.push_back(simulator->sweep(k, executor).scan);
    }

    std::vector<CalibratedBeam> calibrate(int passes)
    {
        registerAll();
        std::vector<CalibratedBeam> beams;
        BeamCorrections corrections;
        for (int pass = 0; pass < passes; pass++)
        {
            const int rings = scans.front().rings;
            BeamCalibrator calibrator(BeamCalibrationConfig(), rings, corrections);
            const auto take = [&](const Event& event)
            {
                if (const auto* refined = std::get_if<Refined>(&event))
                    calibrator.add(refined->sweep, refined->state);
            };
            ConfigSection root;
            OdometryConfig config = OdometryConfig::read(root);
            Pipeline pipeline(config, executor, WarningSink(), take);
            auto sample = simulator->imu().samples.begin();
            for (Scan scan : scans)
            {
                correctBeams(scan, corrections);
                for (; sample != simulator->imu().samples.end() && sample->t <= scan.end; ++sample)
                    pipeline.add(*sample);
                pipeline.add(std::move(scan));
            }
            pipeline.finish();
            beams = calibrator.finish();
            corrections = {};
            for (const CalibratedBeam& b : beams)
            {
                corrections.elevation.push_back(b.elevation);
                corrections.range.push_back(b.range);
            }
            before = pass == 0 ? calibrator.thicknessBefore() : before;
            after = calibrator.thicknessAfter();
        }
        return beams;
    }

    struct Rms
    {
        double elevation = 0, range = 0;
    };

    /** Of the errors of the beams but for what is common to all, which moves no beam against
     * another: as they are, and as they are left. */
    std::pair<Rms, Rms> errors(const std::vector<CalibratedBeam>& beams) const
    {
        const BeamErrors& truth = simulator->lidar().beamErrors();
        const auto rms = [&](const std::function<double(std::size_t)>& error)
        {
            double sum = 0, squares = 0;
            for (std::size_t r = 0; r < beams.size(); r++)
            {
                sum += error(r);
                squares += square(error(r));
            }
            const auto n = static_cast<double>(beams.size());
            return std::sqrt(squares / n - square(sum / n));
        };
        const auto ring = [](std::size_t r) { return static_cast<std::uint16_t>(r); };
        return {
            {rms([&](std::size_t r) { return truth.elevation(ring(r)); }),
             rms([&](std::size_t r) { return truth.range(ring(r)); })},
            {rms([&](std::size_t r) { return truth.elevation(ring(r)) - beams[r].elevation; }),
             rms([&](std::size_t r) { return truth.range(ring(r)) + beams[r].range; })}};
    }

    Executor executor{2};
    std::optional<Simulator> simulator;
    std::vector<Scan> scans;
    double before = 0, after = 0;  // [m] thickness of planes
};
}  // namespace

TEST_F(TheBeams, OfALidarThatIsCarriedThroughAHallAreFound)
{
    walk("hall", 40);
    const std::vector<CalibratedBeam> beams = calibrate(2);
    const auto [as_they_are, left] = errors(beams);
    RecordProperty("elevation_left_mdeg", static_cast<int>(57296 * left.elevation));
    RecordProperty("range_left_um", static_cast<int>(1e6 * left.range));
    // Measured: 85 % and 97 % of the errors are found.
    EXPECT_LT(left.elevation, 0.2 * as_they_are.elevation);
    EXPECT_LT(left.range, 0.06 * as_they_are.range);
    EXPECT_LT(after, 0.9 * before);
    // The deviations are honest: what is common to all beams hardly shows.
    for (const CalibratedBeam& b : beams) EXPECT_TRUE(b.range_shown && b.range_sigma < 0.003);
}
