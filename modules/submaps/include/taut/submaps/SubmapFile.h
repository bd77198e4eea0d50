#pragma once

#include <string>

#include "taut/core/Submap.h"

/** \file SubmapFile.h
 * Submaps on the disk (`.tsm`): "TAUTSUB1", size of the data and CRC-32 of what follows (4 bytes
 * each), then the data, compressed by zlib. Little-endian. */
namespace taut
{
/** The file appears under its name when it is complete and on the disk. Throws std::runtime_error
 * if it cannot be written. */
void writeSubmap(const std::string& path, const Submap& submap);

/** The same bits that were written. Throws std::runtime_error that names the file and the cause:
 * not there, no submap, another version, damaged. */
Submap readSubmap(const std::string& path);
}  // namespace taut
