#include "Options.h"

#include <cmath>

#include "../SensorArguments.h"

namespace taut
{
bool parseOptions(int argc, char** argv, LiveOptions& o)
{
    TCLAP::CmdLine cmd(
        "taut-live: records what sensors give and estimates beside it. Every observation goes to "
        "OUT/log.rawlog as it comes. SIGINT, SIGTERM or --duration end it; then everything is "
        "saved as taut-slam saves it. Exit codes: 0 done, 1 failed, 2 bad usage, 3 done, but part "
        "of what was measured could not be used (the warnings and metrics.json say which and why).",
        ' ', TAUT_VERSION);
    TCLAP::UnlabeledValueArg<std::string> sensors(
        "SENSORS.ini", "The sensors, in a file for MRPT's rawlog-grabber", false, "", "SENSORS.ini",
        cmd);
    TCLAP::ValueArg<std::string> replay(
        "", "replay", "Play the sensors of a rawlog at their pace, instead of SENSORS.ini", false,
        "", "LOG.rawlog", cmd);
    TCLAP::ValueArg<double> speed(
        "", "speed", "Of --replay: 2 is twice as fast, 0 as fast as it is written", false, 1,
        "FACTOR", cmd);
    TCLAP::ValueArg<double> duration("", "duration", "End after so long", false, 0, "SECONDS", cmd);
    SlamArguments common(cmd, FolderOption::Required);
    SensorArguments chosen(cmd);
    TCLAP::SwitchArg never_less(
        "", "never-less",
        "Where there is no time for all of each scan, fall behind instead of using a share", cmd);
    const Usage usage{
        {"velodyne-xsens.ini -o out/today",
         "ouster.ini -p libtaut-grabber.so -o out/today --stream",
         "--replay rawlogs/hall_fast.rawlog -o out/replayed"}};
    if (!parseCommandLine(cmd, argc, argv, usage)) return false;

    common.fill(o);
    o.sensors = sensors.getValue();
    o.replay = replay.getValue();
    if (o.sensors.empty() == o.replay.empty())
        throw UsageError("SENSORS.ini or --replay is needed, and one of them only");
    o.speed = speed.getValue();
    if (!(o.speed >= 0) || !std::isfinite(o.speed))
        throw UsageError("--speed must not be negative");
    o.duration = duration.getValue();
    if (duration.isSet() && !(o.duration > 0 && std::isfinite(o.duration)))
        throw UsageError("--duration must be above 0");
    o.rig = chosen.rig();
    o.lidar_label = chosen.lidarLabel();
    o.imu_label = chosen.imuLabel();
    o.scan_times = chosen.scanTimes();
    o.never_less = never_less.getValue();
    return true;
}
}  // namespace taut
