#pragma once

#include <string>

#include "GzInput.h"
#include "ObjectHeader.h"

namespace taut
{
/** Leaves out an object of a class that taut does not use, and with it all that MRPT would
 * allocate for it. Such objects have no length: one ends before the next header of a class of
 * rawlogs, or with the file. `ends_with_frame`: it is the last one of its sensory frame, so that
 * the frame's end mark follows its own.
 *
 * Returns the label of the sensor as far as it can be told: the fields before it are not known, so
 * it is a text of the stated length close to a time stamp or at the end. Else it is empty.
 *
 * Throws std::runtime_error if the file ends before the object does. Memory does not depend on
 * the object. */
std::string passOver(GzInput& input, const ObjectHeader& header, bool ends_with_frame);
}  // namespace taut
