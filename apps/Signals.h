#pragma once

#include <atomic>

namespace taut
{
/** From now on the first SIGINT, SIGTERM or SIGHUP is noted (interruption()), so that the program
 * can save what was done. The second ends it at once, as if nobody had caught it, even if it hangs.
 * A SIGHUP that is ignored already (nohup) stays so. */
void catchSignals();

/** Whether a signal has come since catchSignals(). */
const std::atomic<bool>& interruption();
}  // namespace taut
