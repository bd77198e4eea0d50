#pragma once

#include <string>

namespace taut
{
/** What a user can say about a recording that is to be imported. A format takes what concerns it.
 */
struct ImportOptions
{
    std::string ouster_json;     //!< description of the Ouster; empty: the capture's, with .json
    bool capture_clock = false;  //!< stamps by the capturing computer instead of the sensor
};
}  // namespace taut
