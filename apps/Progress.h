#pragma once

#include <chrono>
#include <string>

namespace taut
{
/** Tells how far the run is, on standard error: one line that renews itself on a terminal, plain
 * lines a few seconds apart elsewhere. */
class Progress
{
 public:
    explicit Progress(bool show);
    ~Progress();

    /** `fraction` of the log that is read; `scans` and seconds of the recording that are done. */
    void update(double fraction, int scans, double seconds_done);

    /** The same of the second pass, which begins with the first call. */
    void update(double fraction);

    /** Of what has no end that is known. */
    void update(const std::string& line);

    /** Takes the line off the terminal, so that something else can be printed. */
    void clear();

 private:
    bool isDue();
    void draw(double fraction, const std::string& numbers);
    void show(const std::string& begin, const std::string& line);

    using Clock = std::chrono::steady_clock;
    bool show_, terminal_, drawn_ = false;
    bool begun_ = false;
    Clock::time_point start_ = Clock::now(), last_ = start_;
};
}  // namespace taut
