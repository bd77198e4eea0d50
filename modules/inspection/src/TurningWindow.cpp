#include "taut/inspection/TurningWindow.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace taut
{
namespace
{
constexpr Duration kGap = 500'000'000;
constexpr Duration kBin = 1'000'000'000;
}  // namespace

void TurningWindow::add(const ImuSample& sample)
{
    if (!bins_.empty())
    {
        const Duration step = sample.t - bins_.back().end;
        if (step > kGap || step < 0) bins_.clear();
    }
    if (bins_.empty() || sample.t - bins_.back().begin >= kBin)
    {
        judge();
        bins_.push_back({sample.t, sample.t});
        while (toSeconds(sample.t - bins_.front().begin) >= length_) bins_.pop_front();
    }
    Bin& bin = bins_.back();
    bin.end = sample.t;
    bin.count++;
    bin.sum += sample.gyro;
    bin.squares += sample.gyro * sample.gyro.transpose();
}

/* The score is the area of the ellipse that the rates fill: turning about one axis alone tells
 * little. Sums, not means, so that a longer window is better than its best part. */
void TurningWindow::judge()
{
    if (bins_.empty()) return;
    Bin all;
    for (const Bin& bin : bins_)
    {
        all.count += bin.count;
        all.sum += bin.sum;
        all.squares += bin.squares;
    }
    const Matrix3d spread = all.squares - all.sum * all.sum.transpose() / all.count;
    const Vector3d e =
        Eigen::SelfAdjointEigenSolver<Matrix3d>(spread, Eigen::EigenvaluesOnly).eigenvalues();
    const double score = std::sqrt(std::max(0.0, e[1]) * std::max(0.0, e[2]));
    if (score <= best_score_) return;
    best_score_ = score;
    best_ = Window{
        bins_.front().begin, bins_.back().end,
        std::sqrt(std::max(0.0, spread.trace() / all.count))};
}

std::optional<TurningWindow::Window> TurningWindow::best() const
{
    TurningWindow with_last_bin = *this;
    with_last_bin.judge();
    return with_last_bin.best_;
}
}  // namespace taut
