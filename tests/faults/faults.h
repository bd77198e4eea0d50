#pragma once

#include <functional>
#include <string>
#include <vector>

#include "taut/core/Measurement.h"

namespace taut::test
{
/** A recording in the order of its file, to be spoiled. */
using Items = std::vector<Measurement>;

/** Something that goes wrong, and what taut has to make of it. */
struct Fault
{
    std::string name;  //!< of the test
    std::string what;  //!< for the table
    std::function<void(Items&)> spoil;
    int exit_code = 0;
    std::string says;            //!< kind of the warning, or words of the error; empty: nothing
    double error = 0;            //!< [m] most of it against the truth; 0: there is none to speak of
    std::string arguments = "";  //!< of taut-slam, further ones
    std::size_t poses = 100;     //!< at least, of 124
};

/** The faults of recordings. */
const std::vector<Fault>& recordedFaults();
}  // namespace taut::test
