#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ByteReader.h"

namespace taut::bag
{
/** Decompresses "bz2", "lz4" (frame format) or "zstd". Throws std::runtime_error if the method is
 * another, if the data are damaged or if they have not `expected` bytes. Memory follows what really
 * comes out, not what a damaged header claims. */
std::vector<std::uint8_t> decompress(
    const std::string& method, Bytes data, std::optional<std::size_t> expected = {});

/** True if the bytes begin as a zstd frame does. */
bool isZstd(Bytes data);

/** A message without the compression that rosbag2 can give each one (no message begins as zstd
 * does); what it comes to lies in `buffer`. Throws std::runtime_error if it is damaged. */
Bytes plainMessage(Bytes message, std::vector<std::uint8_t>& buffer);
}  // namespace taut::bag
