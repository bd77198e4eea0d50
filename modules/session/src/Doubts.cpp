#include "taut/session/Doubts.h"

#include <algorithm>

namespace taut
{
namespace
{
constexpr double kBridged = 1.0;  // [s] that the IMU alone carries a pose without harm
}

void Doubts::add(const Event& event)
{
    const bool open = !doubts_.empty() && !doubts_.back().recovered;
    if (const auto* lost = std::get_if<Lost>(&event))
    {
        doubts_.push_back({lost->t, lost->t, lost->cause, false});
    }
    else if (const auto* found = std::get_if<Recovered>(&event); found != nullptr && open)
    {
        doubts_.back().to = found->t;
        doubts_.back().recovered = true;
    }
    else if (const auto* estimated = std::get_if<Estimated>(&event); estimated != nullptr && open)
    {
        doubts_.back().to = estimated->result.estimate.state.t;
    }
}

bool Doubts::serious() const
{
    return std::any_of(
        doubts_.begin(), doubts_.end(),
        [](const Doubt& d)
        { return d.cause != "few_correspondences" || toSeconds(d.to - d.from) > kBridged; });
}
}  // namespace taut
