#include "Signals.h"

#include <csignal>

namespace taut
{
namespace
{
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not lock");

void onSignal(int signal)
{
    if (!interrupted.exchange(true)) return;
    std::signal(signal, SIG_DFL);
    std::raise(signal);  // takes effect on the return from here
}
}  // namespace

void catchSignals()
{
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
    if (std::signal(SIGHUP, onSignal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

const std::atomic<bool>& interruption()
{
    return interrupted;
}
}  // namespace taut
