#include <zlib.h>

#include "support.h"
#include "taut/submaps/SubmapFile.h"

/* A submap of a known map. The first byte tells whether these are the bytes of the file, or the
 * data in it, to which the right header is made: no fuzzer finds a CRC-32. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    const bool is_data = input.byte() % 2 == 1;
    std::string file = input.text();
    if (is_data)
    {
        uLongf stored = compressBound(input.size());
        std::string data(stored, '\0');
        compress2(reinterpret_cast<Bytef*>(data.data()), &stored, input.data(), input.size(), 0);
        data.resize(stored);
        const auto size = static_cast<std::uint32_t>(input.size());
        const auto sum = static_cast<std::uint32_t>(
            crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size())));
        file = "TAUTSUB2";
        file.append(reinterpret_cast<const char*>(&size), 4);
        file.append(reinterpret_cast<const char*>(&sum), 4);
        file += data;
    }
    const std::string path = folder.write("00000.tsm", file);
    fuzz::readOrRefuse(
        [&]
        {
            const Submap submap = readSubmap(path);
            fuzz::require(!submap.scans.empty(), "a submap has scans");
            for (const SubmapPoint& point : submap.points)
                fuzz::require(point.scan < submap.scans.size(), "a point has its scan");
        });
}
