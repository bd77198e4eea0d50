#include "imported.h"

#include "../importing/OusterSimulator.h"

/* A packet capture: pcap or pcapng. An Ouster's description lies beside it. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    static const std::string description =
        folder.write("a.json", test::OusterSimulator().description().dump());
    const std::string path = folder.write("a.pcap", input);
    for (const bool capture_clock : {false, true})
    {
        ImportOptions options;
        options.capture_clock = capture_clock;
        fuzz::readOrRefuse([&] { fuzz::importAll(path, options); });
    }
}
