#include "Progress.h"

#include <mrpt/system/progress.h>
#include <unistd.h>

#include <cstdio>

namespace taut
{
Progress::Progress(bool show) : show_(show), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress()
{
    clear();
}

void Progress::clear()
{
    if (!drawn_) return;
    std::fprintf(stderr, "\r\033[K");
    std::fflush(stderr);
    drawn_ = false;
}

void Progress::update(double fraction, int scans, double seconds_done)
{
    const auto now = Clock::now();
    const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
    if (!show_ || seconds(now - last_) < (terminal_ ? 0.2 : 5.0)) return;
    last_ = now;
    const double wall = seconds(now - start_);
    const double left = fraction > 1e-3 ? wall * (1 - fraction) / fraction : 0;
    char numbers[160];
    std::snprintf(
        numbers, sizeof numbers,
        "%5.1f %%  %.1f s done  %.1f scans/s  %.1f x real time  ETA %.0f s", 100 * fraction,
        seconds_done, scans / wall, seconds_done / wall, left);
    if (!terminal_)
    {
        std::fprintf(stderr, "%s\n", numbers);
        return;
    }
    std::fprintf(stderr, "\r\033[K%s %s", mrpt::system::progress(fraction, 20).c_str(), numbers);
    std::fflush(stderr);
    drawn_ = true;
}
}  // namespace taut
