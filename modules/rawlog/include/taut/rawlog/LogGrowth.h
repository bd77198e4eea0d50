#pragma once

#include <functional>

namespace taut
{
/** What becomes of a log whose end was reached while somebody may be writing it. */
enum class LogGrowth
{
    More,      //!< there may be more: read on
    Complete,  //!< no more comes: that it is cut off is damage
    Left  //!< it may grow on, but is not waited for any longer: an object that is begun is left
};

/** Called where the log ends, in the thread that reads; waits, but for less than a second at a
 * time. After Complete or Left it is asked no more. Empty: the log does not grow. */
using WaitForGrowth = std::function<LogGrowth()>;
}  // namespace taut
