#pragma once

#include "../ImportFormat.h"

namespace taut
{
/** By the first bytes: pcap in either order of bytes, with micro- or nanoseconds, or pcapng. */
bool isPcap(const Recording& recording);

std::unique_ptr<ImportSource> openPcap(
    const Recording& recording, const ImportOptions& options, const WarningSink& warn);
}  // namespace taut
