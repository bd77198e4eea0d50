#include "imported.h"

/* A sweep as a table of text, in a folder. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    folder.write("1700000000.25.csv", input);
    fuzz::readOrRefuse([] { fuzz::importAll(folder.path()); });
}
