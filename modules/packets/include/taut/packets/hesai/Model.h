#pragma once

#include <cstdint>
#include <string>

namespace taut::hesai
{
enum class Model : std::uint8_t
{
    Pandar40P,
    Pandar64,
    Qt64,   //!< PandarQT
    Qt128,  //!< QT128C2X
    Xt16,
    Xt32,
    Xt32M,  //!< XT32M2X
};

/** "Pandar40P" */
std::string nameOf(Model model);

/** Number of lasers, which is that of the rings. */
int lasersOf(Model model);
}  // namespace taut::hesai
