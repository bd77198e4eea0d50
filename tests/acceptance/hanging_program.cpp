// Catches signals as all programs do, and hangs.
#include <fstream>
#include <string>

#include "../../apps/Signals.h"

int main(int /*argc*/, char** argv)
{
    taut::catchSignals();
    std::ifstream pipe(argv[1]);
    std::string line;
    while (std::getline(pipe, line))
    {
    }
    return 0;
}
