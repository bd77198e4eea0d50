#include "bags.h"

/* The metadata.yaml of a bag of one part; the part is no bag. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    static const std::string part = folder.write("a_0.mcap", std::string("\x89MCAP0\r\n", 8));
    folder.write("metadata.yaml", input);
    fuzz::readOrRefuse(
        [] { fuzz::readMessages(*bag::openBagReader(folder.path(), [](const Warning&) {})); });
}
