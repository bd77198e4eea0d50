#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "taut/rawlog/RawlogSource.h"

/* Any bytes are read as a rawlog to their end, or refused with a std::runtime_error. The rig gives
 * the rows of range images, so that these are converted too. */
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const int file = memfd_create("log.rawlog", 0);
    if (file < 0) return 0;
    if (write(file, data, size) == static_cast<ssize_t>(size))
    {
        try
        {
            taut::RawlogConfig config;
            config.path = "/proc/self/fd/" + std::to_string(file);
            config.rig.lidar.row_elevations = {{-0.4, 0.2}};
            taut::RawlogSource source(config, [](const taut::Warning&) {});
            while (source.next())
            {
            }
        }
        catch (const std::runtime_error&)
        {
            // the way of saying that nothing can be made of it
        }
    }
    close(file);
    return 0;
}
