#pragma once

#include <string>

#include "Blocks.h"

namespace taut
{
/** What the page's script reads, but for the points: a JSON text and a block of floats. */
struct PageData
{
    std::string json;     //!< safe inside of a script element
    std::string numbers;  //!< floats that `json` refers to by position and count
};

/** `points`: told of in the JSON. Throws std::invalid_argument as writeReport() does. */
PageData pageData(const Report& report, const PackedPoints& points);

/** A text that stands for itself between tags. Bytes that are not UTF-8 are replaced. */
std::string escaped(const std::string& text);
}  // namespace taut
