#include "Progress.h"

#include <mrpt/system/progress.h>
#include <unistd.h>

#include <cstdio>

#include "taut/core/format.h"

namespace taut
{
namespace
{
double seconds(std::chrono::steady_clock::duration d)
{
    return std::chrono::duration<double>(d).count();
}
}  // namespace

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
    if (!isDue()) return;
    const double wall = seconds(last_ - start_);
    draw(
        fraction, format(
                      "%.1f s done  %.1f scans/s  %.1f x real time", seconds_done, scans / wall,
                      seconds_done / wall));
}

void Progress::update(double fraction)
{
    if (!begun_) start_ = last_ = Clock::now();
    begun_ = true;
    if (isDue()) draw(fraction, "undistorting again");
}

bool Progress::isDue()
{
    const auto now = Clock::now();
    if (!show_ || seconds(now - last_) < (terminal_ ? 0.2 : 5.0)) return false;
    last_ = now;
    return true;
}

void Progress::draw(double fraction, const std::string& numbers)
{
    const double wall = seconds(last_ - start_);
    const double left = fraction > 1e-3 ? wall * (1 - fraction) / fraction : 0;
    const std::string line =
        format("%5.1f %%  ", 100 * fraction) + numbers + format("  ETA %.0f s", left);
    show(mrpt::system::progress(fraction, 20) + " ", line);
}

void Progress::update(const std::string& line)
{
    if (isDue()) show("", line);
}

/* `begin` on a terminal alone. */
void Progress::show(const std::string& begin, const std::string& line)
{
    if (!terminal_)
    {
        std::fprintf(stderr, "%s\n", line.c_str());
        return;
    }
    std::fprintf(stderr, "\r\033[K%s%s", begin.c_str(), line.c_str());
    std::fflush(stderr);
    drawn_ = true;
}
}  // namespace taut
