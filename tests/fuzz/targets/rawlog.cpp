#include <optional>

#include "support.h"
#include "taut/rawlog/RawlogSource.h"

/* A rawlog. The rig gives the rows of range images, so that these are converted too. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    RawlogConfig config;
    config.path = folder.write("a.rawlog", input);
    config.rig.lidar.row_elevations = {{-0.4, 0.2}};
    fuzz::readOrRefuse(
        [&]
        {
            RawlogSource source(config, [](const Warning&) {});
            std::optional<Time> last_sample, last_scan;
            while (const auto measurement = source.next())
            {
                const auto* sample = std::get_if<ImuSample>(&*measurement);
                const Time t = sample ? sample->t : std::get<Scan>(*measurement).end;
                std::optional<Time>& last = sample ? last_sample : last_scan;
                fuzz::require(!last || t > *last, "measurements are in the order of time");
                last = t;
            }
        });
}
