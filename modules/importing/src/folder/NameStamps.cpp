#include "NameStamps.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "taut/core/TimeText.h"

namespace taut
{
namespace
{
constexpr Time kLatest = 4'000'000'000'000'000'000;                  // ns, the year 2096
constexpr std::size_t kFewestDigits = 13;                            // of milliseconds since 1970
constexpr Duration kShortest = 2'000'000, kLongest = 2'000'000'000;  // from sweep to sweep
constexpr Duration kBeside = 10'000'000'000;  // of the IMU: it may have started later
const std::pair<Time, const char*> kUnits[] = {
    {1, "nanoseconds"}, {1000, "microseconds"}, {1'000'000, "milliseconds"}};

/** A name that is a whole number, long enough for a stamp. */
std::optional<Time> wholeNumber(const std::filesystem::path& file)
{
    const std::string name = file.stem().string();
    Time value = 0;
    const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), value);
    if (error != std::errc() || stop != name.data() + name.size() || value < 0 ||
        name.size() < kFewestDigits || value > kLatest)
        return {};
    return value;
}

/** "1700000000_123456789" as "1700000000.123456789". */
std::string withPoint(std::string name)
{
    const auto mark = name.find_first_of("_-");
    if (mark != std::string::npos && mark >= 9 && name.size() == mark + 10) name[mark] = '.';
    return name;
}

Duration usualStep(std::vector<Time> numbers)
{
    std::sort(numbers.begin(), numbers.end());
    std::vector<Duration> steps;
    for (std::size_t i = 1; i < numbers.size(); i++) steps.push_back(numbers[i] - numbers[i - 1]);
    if (steps.empty()) return 0;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
}

/** By what a stamp of today has. */
Time unitByDigits(Time number)
{
    return number >= 100'000'000'000'000'000 ? 1 : number >= 100'000'000'000'000 ? 1000 : 1'000'000;
}
}  // namespace

NameStamps::NameStamps(
    const std::vector<std::filesystem::path>& files,
    const std::optional<std::pair<Time, Time>>& span)
{
    std::vector<Time> numbers;
    for (const auto& file : files)
        if (const auto number = wholeNumber(file)) numbers.push_back(*number);
    if (numbers.empty()) return;
    const auto [first, last] = std::minmax_element(numbers.begin(), numbers.end());
    const Duration step = usualStep(numbers);
    std::vector<std::pair<Time, const char*>> by_step, by_span;
    for (const auto& unit : kUnits)
    {
        if (*last > kLatest / unit.first) continue;
        if (step > 0 && step < kLongest && step * unit.first >= kShortest &&
            step * unit.first < kLongest)
            by_step.push_back(unit);
        if (span && *first * unit.first <= span->second + kBeside &&
            *last * unit.first >= span->first - kBeside)
            by_span.push_back(unit);
    }
    unit_ = unitByDigits(*last);
    std::string reason = "the number of their digits";
    const bool step_fits =
        !by_step.empty() &&
        (by_span.empty() ||
         std::find(by_span.begin(), by_span.end(), by_step.front()) != by_span.end());
    if (step_fits)
    {
        unit_ = by_step.front().first;
        reason = "how they follow each other";
    }
    else if (by_span.size() == 1)
    {
        unit_ = by_span.front().first;
        reason = "the times of the IMU";
    }
    for (const auto& [unit, name] : kUnits)
        if (unit == unit_)
            finding_ = std::string("names of the clouds: ") + name + ", by " + reason;
}

std::optional<Time> NameStamps::of(const std::filesystem::path& file) const
{
    if (const auto number = wholeNumber(file))
        return *number <= kLatest / unit_ ? std::optional(*number * unit_) : std::nullopt;
    const std::string name = withPoint(file.stem().string());
    if (name.find('.') == std::string::npos) return {};
    try
    {
        const Time stamp = parseSeconds(name);
        if (stamp >= -kLatest && stamp <= kLatest) return stamp;
    }
    catch (const std::invalid_argument&)
    {
    }
    return {};
}
}  // namespace taut
