#pragma once

#include <vector>

#include "taut/core/Scan.h"
#include "taut/rawlog/RawlogWriter.h"

namespace taut
{
/** The packets of a sweep whose points know their laser and time, the head being at `azimuth` [deg]
 * at the scan's stamp. Points that are not finite become shots without a return. */
std::vector<velodyne::Packet> packetsOf(
    const Scan& scan, velodyne::Model model, double azimuth, double rotation_rate);

/** What a reader finds in the packets; all times relative to the stamp of the scan. */
Scan decoded(const PacketScan& packets);
}  // namespace taut
