#include "SeamFinder.h"

#include <algorithm>
#include <cmath>

#include "SweepOrder.h"

namespace taut
{
namespace
{
constexpr int kBins = Panorama::kBins;
constexpr double kStep = 0.03;       // [m] of range: less is noise
constexpr double kMoved = 0.15;      // misfit across sweeps more than within: the sensor moved
constexpr double kFewest = 20;       // places that must tell of an azimuth
constexpr double kClear = 0.4;       // of the contrast: a seam stands out by as much
constexpr double kSecond = 0.6;      // of the best: no other place or sense may fit as well
constexpr int kBlur = 3;             // bins around the best that may
constexpr double kOneSurface = 0.1;  // of the range: larger steps between neighbours are edges

double median(std::vector<double> values)
{
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/** Range at an azimuth, from the two bins on one side of it; nothing if they see no one surface. */
std::optional<double> extrapolated(double near, double far)
{
    if (near <= 0 || far <= 0 || std::abs(near - far) > kOneSurface * std::min(near, far))
        return {};
    return 1.5 * near - 0.5 * far;
}
}  // namespace

bool SeamFinder::Misfits::known() const
{
    return std::min({same.count, growing.count, falling.count}) >= kFewest;
}

std::vector<SeamFinder::Misfits> SeamFinder::misfitsOf(
    const Panorama& first, const Panorama& second)
{
    std::vector<Misfits> misfits(kBins);
    const auto compare = [](Misfit& to, std::optional<double> a, std::optional<double> b)
    {
        if (!a || !b) return;
        to.sum += std::log1p(square((*a - *b) / kStep));
        to.count++;
    };
    for (int row = 0; row < Panorama::kRows; row++)
        for (int b = 0; b < kBins; b++)
        {
            // Just below the lower edge of bin b, and just above it.
            const auto below = [&](const Panorama& p)
            { return extrapolated(p.range(row, b - 1), p.range(row, b - 2)); };
            const auto above = [&](const Panorama& p)
            { return extrapolated(p.range(row, b), p.range(row, b + 1)); };
            Misfits& m = misfits[static_cast<std::size_t>(b)];
            compare(m.same, below(first), above(first));
            compare(m.growing, below(first), above(second));
            compare(m.falling, above(first), below(second));
        }
    return misfits;
}

void SeamFinder::add(const Panorama& first, const Panorama& second)
{
    const auto misfits = misfitsOf(first, second);
    std::vector<double> contrasts;
    for (const Misfits& m : misfits)
        if (std::min({m.same.count, m.growing.count, m.falling.count}) > 0)
            contrasts.push_back(m.contrast());
    if (median(std::move(contrasts)) < kMoved) return;
    pairs_++;
    for (std::size_t b = 0; b < misfits.size(); b++)
        for (const auto part : {&Misfits::same, &Misfits::growing, &Misfits::falling})
        {
            (misfits_[b].*part).sum += (misfits[b].*part).sum;
            (misfits_[b].*part).count += (misfits[b].*part).count;
        }
}

double SeamFinder::contrast() const
{
    std::vector<double> contrasts;
    for (const Misfits& m : misfits_)
        if (m.known()) contrasts.push_back(m.contrast());
    return median(std::move(contrasts));
}

std::optional<SeamFinder::Seam> SeamFinder::seam() const
{
    if (!decided()) return {};
    const double clear = kClear * contrast();
    struct Guess
    {
        int bin;
        double sense, gain;
    };
    std::vector<Guess> guesses;
    for (int b = 0; b < kBins; b++)
    {
        const Misfits& m = misfits_[static_cast<std::size_t>(b)];
        if (!m.known()) continue;
        guesses.push_back({b, 1, m.same.mean() - m.growing.mean()});
        guesses.push_back({b, -1, m.same.mean() - m.falling.mean()});
    }
    if (guesses.empty()) return {};
    const auto less = [](const Guess& a, const Guess& b) { return a.gain < b.gain; };
    const Guess best = *std::max_element(guesses.begin(), guesses.end(), less);
    if (best.gain < clear) return {};
    for (const Guess& other : guesses)
    {
        const int bins = std::abs(other.bin - best.bin), apart = std::min(bins, kBins - bins);
        const bool is_same = apart <= kBlur && other.sense == best.sense;
        if (!is_same && other.gain > kSecond * best.gain) return {};
    }
    return Seam{wrapped(2 * M_PI * best.bin / kBins), best.sense};
}

bool SeamFinder::fitsEverywhere() const
{
    if (!decided()) return false;
    const double clear = kClear * contrast();
    std::size_t known = 0;
    for (const Misfits& m : misfits_)
    {
        if (!m.known()) continue;
        known++;
        if (m.same.mean() - std::min(m.growing.mean(), m.falling.mean()) > -clear) return false;
    }
    return known == kBins;
}
}  // namespace taut
