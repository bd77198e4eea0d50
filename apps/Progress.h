#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>

namespace taut
{
/** Tells on stderr how far a long job is: a bar that is redrawn on a terminal, a line every tenth
 * of the way elsewhere. */
class Progress
{
 public:
    /** @param what names the things counted: "scans" */
    Progress(std::size_t total, std::string what, bool quiet = false)
        : total_(std::max<std::size_t>(total, 1)), what_(std::move(what)), quiet_(quiet)
    {
    }

    /** `done` things of the total are done. */
    void show(std::size_t done)
    {
        const double share = static_cast<double>(done) / static_cast<double>(total_);
        const double seconds = elapsed();
        const bool last = done >= total_;
        if (quiet_ || (!last && (terminal_ ? seconds < next_time_ : share < next_share_))) return;
        next_time_ = seconds + 0.1;
        next_share_ = share + 0.1;
        const double rate = static_cast<double>(done) / std::max(seconds, 1e-3);
        const double left = rate > 0 ? static_cast<double>(total_ - done) / rate : 0;
        const auto filled = static_cast<int>(30 * share);
        const std::string bar = std::string(filled, '#') + std::string(30 - filled, '.');
        std::fprintf(
            stderr,
            terminal_ ? "\r[%s] %3.0f %% %zu of %zu %s, %.0f/s, %.0f s left  %s"
                      : "[%s] %3.0f %% %zu of %zu %s, %.0f/s, %.0f s left%s\n",
            bar.c_str(), 100 * share, done, total_, what_.c_str(), rate, left,
            last && terminal_ ? "\n" : "");
    }

 private:
    double elapsed() const
    {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

    std::size_t total_;
    std::string what_;
    bool quiet_;
    bool terminal_ = isatty(STDERR_FILENO) != 0;
    double next_time_ = 0, next_share_ = 0.1;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};
}  // namespace taut
