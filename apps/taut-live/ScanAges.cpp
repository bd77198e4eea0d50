#include "ScanAges.h"

namespace taut
{
namespace
{
constexpr std::size_t kMost = 100'000;  // hours, of stamps that nobody asks for
}  // namespace

void ScanAges::add(Time stamp, Clock::time_point whole)
{
    const std::lock_guard lock(mutex_);
    whole_[stamp] = whole;
    if (whole_.size() > kMost) whole_.erase(whole_.begin());
}

std::optional<double> ScanAges::of(const Scan& scan)
{
    const std::lock_guard lock(mutex_);
    const auto found = whole_.find(scan.stamp - clock_offset_);
    if (found == whole_.end()) return {};
    const double age = std::chrono::duration<double>(Clock::now() - found->second).count();
    whole_.erase(whole_.begin(), std::next(found));
    return age;
}
}  // namespace taut
