#include <array>

#include "PacketLayout.h"
#include "taut/packets/hesai/Decoder.h"

/** \file firingTime.cpp
 * When lasers fire [ns]: since the begin of their firing, which is itself before or after the
 * packet's time stamp (PandarQT: after it; else before it, but for the last one). */
namespace taut::hesai
{
namespace
{
constexpr std::array<int, 40> kPandar40P{
    -42220, -28470, -16040, -3620,  -45490, -31740, -47460, -54670, -20620, -33710,
    -40910, -8190,  -20620, -27160, -50730, -8190,  -14740, -36980, -45490, -52700,
    -23890, -31740, -38950, -11470, -18650, -25190, -48760, -6230,  -12770, -35010,
    -21920, -9500,  -43520, -29770, -17350, -4920,  -42220, -28470, -16040, -3620};

constexpr std::array<int, 64> kPandar64{
    -23180, -21876, -20572, -19268, -17964, -16660, -11444, -46796, -7532,  -36956, -50732,
    -54668, -40892, -44828, -31052, -34988, -48764, -52700, -38924, -42860, -29084, -33020,
    -46796, -25148, -36956, -50732, -27116, -40892, -44828, -31052, -34988, -48764, -25148,
    -38924, -42860, -29084, -33020, -52700, -6228,  -54668, -15356, -27116, -10140, -23180,
    -4924,  -21876, -14052, -17964, -8836,  -19268, -3620,  -20572, -12748, -16660, -7532,
    -11444, -6228,  -15356, -10140, -4924,  -3620,  -14052, -8836,  -12748};

constexpr std::array<int, 64> kQt64{
    12310,  14370,  16430,  18490,  20540,  22600,  24660,  26710,  29160,  31220,  33280,
    35340,  37390,  39450,  41500,  43560,  46610,  48670,  50730,  52780,  54840,  56900,
    58950,  61010,  63450,  65520,  67580,  69630,  71690,  73740,  75800,  77860,  80900,
    82970,  85020,  87080,  89140,  91190,  93250,  95300,  97750,  99820,  101870, 103930,
    105980, 108040, 110100, 112150, 115200, 117260, 119320, 121380, 123430, 125490, 127540,
    129600, 132050, 134110, 136170, 138220, 140280, 142340, 144390, 146450};

/** The QT128 fires 96 of its lasers at a time: channels 33 to 128 in the first loop, 1 to 32 and 65
 * to 128 in the second. */
constexpr std::array<int, 128> kQt128First{
    0,     0,     0,     0,     0,     0,     0,     0,     0,      0,     0,     0,     0,
    0,     0,     0,     0,     0,     0,     0,     0,     0,      0,     0,     0,     0,
    0,     0,     0,     0,     0,     0,     27656, 53000, 2312,   78344, 81512, 5480,  56168,
    30824, 33992, 59336, 8648,  84680, 87848, 11816, 62504, 37160,  40328, 65672, 14984, 91016,
    94184, 18152, 68840, 43496, 46664, 72008, 21320, 97352, 100520, 24488, 75176, 49832, 1456,
    77488, 26800, 52144, 55312, 29968, 80656, 4624,  7792,  83824,  33136, 58480, 61648, 36304,
    86992, 10960, 14128, 90160, 39472, 64816, 67984, 42640, 93328,  17296, 20464, 96496, 45808,
    71152, 74320, 48976, 99664, 23632, 25944, 51288, 600,   76632,  79800, 3768,  54456, 29112,
    32280, 57624, 6936,  82968, 86136, 10104, 60792, 35448, 38616,  63960, 13272, 89304, 92472,
    16440, 67128, 41784, 44952, 70296, 19608, 95640, 98808, 22776,  73464, 48120};

constexpr std::array<int, 128> kQt128Second{
    2312,  78344, 27656, 53000, 56168,  30824, 81512, 5480,  8648,  84680, 33992, 59336, 62504,
    37160, 87848, 11816, 14984, 91016,  40328, 65672, 68840, 43496, 94184, 18152, 21320, 97352,
    46664, 72008, 75176, 49832, 100520, 24488, 0,     0,     0,     0,     0,     0,     0,
    0,     0,     0,     0,     0,      0,     0,     0,     0,     0,     0,     0,     0,
    0,     0,     0,     0,     0,      0,     0,     0,     0,     0,     0,     0,     600,
    76632, 25944, 51288, 54456, 29112,  79800, 3768,  6936,  82968, 32280, 57624, 60792, 35448,
    86136, 10104, 13272, 89304, 38616,  63960, 67128, 41784, 92472, 16440, 19608, 95640, 44952,
    70296, 73464, 48120, 98808, 22776,  26800, 52144, 1456,  77488, 80656, 4624,  55312, 29968,
    33136, 58480, 7792,  83824, 86992,  10960, 61648, 36304, 39472, 64816, 14128, 90160, 93328,
    17296, 67984, 42640, 45808, 71152,  20464, 96496, 99664, 23632, 74320, 48976};

/** How the firings of a packet follow each other. */
struct Firing
{
    double period;  // [ns]
    double last;    // the begin of the last one since the packet's stamp [ns]
};

Firing firingOf(Model model)
{
    switch (model)
    {
        case Model::Pandar40P:
            return {55560, -28580};
        case Model::Pandar64:
            return {55560, -42580};
        case Model::Qt128:
            return {111110, 9000};
        case Model::Qt64:
        case Model::Xt16:
        case Model::Xt32:
        case Model::Xt32M:
            break;
    }
    return {50000, 5632};
}

double sinceFiring(const PacketInfo& info, int block, int laser)
{
    constexpr double kFirstOfXt = 368;
    const auto i = static_cast<std::size_t>(laser);
    switch (info.model)
    {
        case Model::Pandar40P:
            return kPandar40P[i];
        case Model::Pandar64:
            return kPandar64[i];
        case Model::Qt64:
            return kQt64[i];
        case Model::Qt128:
            return (info.returns == 1 ? block % 2 == 0 : info.first_loop) ? kQt128First[i]
                                                                          : kQt128Second[i];
        case Model::Xt16:
            return kFirstOfXt + 3024 * laser;
        case Model::Xt32:
            break;
        case Model::Xt32M:  // both halves at once
            return kFirstOfXt + 2888 * (laser % 16);
    }
    return kFirstOfXt + 1512 * laser;
}
}  // namespace

double firingTime(const PacketInfo& info, int block, int laser)
{
    const int firing = block / info.returns;
    const int after_it = (blocksOf(info.model) - 1) / info.returns - firing;
    if (info.model == Model::Qt64)
        return 25710 + 500000.0 / 3 * firing + sinceFiring(info, block, laser);
    const Firing pattern = firingOf(info.model);
    return pattern.last - after_it * pattern.period + sinceFiring(info, block, laser);
}
}  // namespace taut::hesai
