#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "taut/core/Time.h"

/** \file Decoder.h
 * Velodyne data packets to points. Pure functions over bytes: neither MRPT nor files nor clocks.
 *
 * Sources: VLP-16 User Manual 63-9243, HDL-32E User Manual 63-9113, VLP-32C User Manual 63-9325 and
 * VLS-128 User Manual 63-9480 (packet layout, firing times, angles). Both lasers and blocks are
 * fired at fixed times after the packet's time stamp, which is that of the first firing in the
 * packet:
 *
 *   VLP-16   2.304 us a laser, 55.296 us a firing sequence of 16, two sequences a block
 *   HDL-32E  1.152 us a laser, 46.080 us a firing sequence of 32, one sequence a block
 *   VLP-32C  2.304 us a pair of lasers, 55.296 us a firing sequence of 32, one sequence a block
 *   VLS-128  2.665 us a group of 8 lasers and as long a pause after 8 groups, 53.3 us a firing
 *            sequence of 128, which fills four blocks; the first group 8.7 us before the stamp
 *
 * In dual-return mode blocks come in pairs of the same firings: last return, then strongest (or
 * second strongest where the last is the strongest). */
namespace taut::velodyne
{
inline constexpr std::size_t kPacketBytes = 1206;  //!< the UDP payload of a data packet
inline constexpr int kBlocks = 12;                 //!< in a packet
inline constexpr int kReturnsPerBlock = 32;
inline constexpr double kRangeUnit = 0.002;   //!< of a VLP-16 and an HDL-32E [m]
inline constexpr double kAzimuthUnit = 0.01;  //!< [deg]

enum class Model : std::uint8_t
{
    Hdl32 = 0x21,
    Vlp16 = 0x22,
    Vlp32 = 0x28,   //!< VLP-32C
    Vls128 = 0xa1,  //!< also sold as Alpha Prime
};

enum class ReturnMode : std::uint8_t
{
    Strongest = 0x37,
    Last = 0x38,
    Dual = 0x39,
};

/** How a model fires. */
struct FiringPattern
{
    int lasers;              //!< in a firing sequence; also the number of rings
    int sequences;           //!< firing sequences in a block
    double laser_period;     //!< from one laser, or group that fires at once, to the next [ns]
    double sequence_period;  //!< [ns], recharge included
    int at_once = 1;         //!< lasers that fire together
    int blocks = 1;          //!< that a firing sequence fills
    int pause_after = 0;     //!< groups before a pause of one laser_period; 0: none
    double first = 0;        //!< time of the first laser of all since the packet's stamp [ns]
    double range_unit = kRangeUnit;  //!< [m]

    /** From a block to the next one that other firings fill [ns]. */
    double blockPeriod() const { return sequences * sequence_period; }

    /** Since the first laser of the firing sequence [ns]. */
    double laserTime(int laser) const;
};
const FiringPattern& firingPattern(Model model);

/** Where one laser points. */
struct Laser
{
    double elevation = 0;           //!< [rad], up
    double azimuth_correction = 0;  //!< [rad], subtracted from the azimuth of the head
    double range_correction = 0;    //!< [m], added to the range
    double vertical_offset = 0;     //!< [m] of the emitter, across the beam, up
    double horizontal_offset = 0;   //!< [m] of the emitter, across the beam, to the left
};
using Calibration = std::vector<Laser>;  //!< by laser index

/** The data sheet's angles. */
const Calibration& defaultCalibration(Model model);

/** What the end of a packet says about it. */
struct PacketInfo
{
    std::uint32_t microseconds = 0;  //!< past the hour, device clock, of the first firing
    Model model = Model::Vlp16;
    ReturnMode mode = ReturnMode::Strongest;
};

/** Blocks of a packet that hold the same firings: the returns of dual mode, the banks of a VLS-128.
 */
int blocksPerFiring(const PacketInfo& info);

/** Blocks that hold firings; a VLS-128 in dual mode leaves some empty. */
int usedBlocks(const PacketInfo& info);

/** Time that the firings of a packet take [ns]. */
Duration packetDuration(const PacketInfo& info);

/** Throws std::runtime_error if the model or the return mode is not one of those above. */
PacketInfo packetInfo(const std::uint8_t* packet);

/** One return. Axes: x at azimuth 0, y to the left, z up (azimuth runs clockwise). */
struct Return
{
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  //!< [m], sensor frame
    float azimuth = 0;        //!< [deg] of the head at the time of this laser, 0 to 360
    std::int32_t offset = 0;  //!< time since the packet's time stamp [ns]
    std::uint8_t laser = 0;   //!< index in the firing sequence
    std::uint8_t intensity = 0;
    std::uint8_t block = 0;  //!< of the packet, 0 to 11
};

/** Appends the valid returns of a packet of kPacketBytes; gives its info. Slots with range 0 are no
 * returns; in dual mode a second return equal to the first is left out. Azimuths within a block
 * come from the median turning rate of the packet (as do times after a sector that is left out), or
 * from `turning_rate` [deg/ns] where a packet holds one firing sequence only (VLS-128, dual).
 * Throws std::runtime_error on an unknown model or mode, on a block with a wrong flag (0xEEFF, or
 * that of a bank) and on a calibration of another number of lasers. */
PacketInfo decodePacket(
    const std::uint8_t* packet, const Calibration& calibration, std::vector<Return>& returns,
    double turning_rate = 0);

/** Azimuth of a block as it is in the packet [0.01 deg]. */
std::uint16_t blockAzimuth(const std::uint8_t* packet, int block);

/** Unrolls the packets' microseconds past the hour to time since the first packet. */
class PacketClock
{
 public:
    /** Time since the first packet [ns]. Steps of up to half an hour, forward or backward, are told
     * apart over the full hour. */
    Duration sinceFirst(std::uint32_t microseconds);

 private:
    bool started_ = false;
    std::uint32_t last_ = 0;
    Duration elapsed_ = 0;
};
}  // namespace taut::velodyne
