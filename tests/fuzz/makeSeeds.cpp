#include <cstdio>
#include <exception>

#include "seeds.h"

/** makeSeeds OUT SOURCE: writes the seeds of all targets, with the writers of the tests. */
int main(int argc, char** argv)
{
    if (argc != 3) return 2;
    try
    {
        const taut::fuzz::Seeds seeds(argv[1]);
        taut::fuzz::addImportSeeds(seeds);
        taut::fuzz::addRawlogSeeds(seeds);
        taut::fuzz::addFileSeeds(seeds, argv[2]);
        return 0;
    }
    catch (const std::exception& e)
    {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
