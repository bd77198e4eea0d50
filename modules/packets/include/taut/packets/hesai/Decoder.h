#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/Time.h"
#include "taut/packets/hesai/Correction.h"
#include "taut/packets/hesai/Model.h"

/** \file Decoder.h
 * Hesai data packets (UDP payloads) to points. Pure functions over bytes: neither files nor sockets
 * nor clocks; all times are the sensor's.
 *
 * Sources: user manuals of Pandar40P, Pandar64, PandarQT, QT128C2X, PandarXT and XT32M2X: packet
 * layout, firing times, angles. Each laser fires at a fixed time before or after the packet's time
 * stamp. The azimuth of a block is that of all its lasers; a correction file tells where a laser
 * looks from there. */
namespace taut::hesai
{
/** What a packet says about itself. */
struct PacketInfo
{
    Model model = Model::Xt32;
    int returns = 1;  //!< of each firing: a block each
    Time t = 0;       //!< the packet's time stamp
    /** QT128, several returns: which half of its outer lasers fires. */
    bool first_loop = true;
};

/** The model, by size and header; nothing if these are of no sensor that is known here. */
std::optional<Model> modelOf(const std::uint8_t* packet, std::size_t bytes);

/** Throws std::runtime_error if the packet is of no known model (naming what it says to be), of
 * another length than its model sends, or has a return mode or a date that is none. */
PacketInfo packetInfo(const std::uint8_t* packet, std::size_t bytes);

/** One return, in the sensor's frame: y at azimuth 0, x to the right of it (azimuth runs
 * clockwise), z up. */
struct Return
{
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  //!< [m]
    std::int32_t offset = 0;                             //!< since the packet's time stamp [ns]
    std::uint8_t laser = 0;                              //!< channel less one
    std::uint8_t reflectivity = 0;
    std::uint8_t block = 0;  //!< of the packet
};

/** Appends the valid returns of a packet; gives its info. Those nearer than the data sheet's
 * shortest range come from within the sensor and are left out. Of returns of one firing that are
 * less than 10 cm apart, which no sensor separates, the last in the packet is taken. Throws as
 * packetInfo(), and on a calibration of another number of lasers or a block without its flag. */
PacketInfo decodePacket(
    const std::uint8_t* packet, std::size_t bytes, const Calibration& calibration,
    std::vector<Return>& returns);

/** Azimuth of a block as it is in the packet [0.01 deg]. */
std::uint16_t blockAzimuth(const std::uint8_t* packet, Model model, int block);

/** The data sheet's shortest range [m]. */
double shortestRange(Model model);

/** Blocks of a packet. */
int blocksOf(Model model);

/** When a laser fires, since the packet's time stamp [ns]. */
double firingTime(const PacketInfo& info, int block, int laser);
}  // namespace taut::hesai
