#include "taut/places/PlacesByView.h"

#include <algorithm>
#include <cmath>

IMPLEMENTS_MRPT_OBJECT(PlacesByView, taut::PlaceRecognizer, taut)

namespace taut
{
namespace
{
constexpr double kShiftSigma = 0.7;   // [m] of a match
constexpr double kHeightSigma = 0.3;  // [m]
constexpr double kTurnSigma = 0.035;  // [rad]
}  // namespace

void PlacesByView::configure(ConfigSection& s)
{
    s.key("unsure", config.unsure, kNotNegative, "m, of pairs that the graph knows no better");
    s.key("min_score", config.min_score, {0, 1}, "of a match of two views");
    s.key("min_cells", config.min_cells, {1, 1e6}, "in which something stands");
    s.key("most", config.most, {1, 100}, "candidates of a submap");
}

void PlacesByView::add(const Submap& submap)
{
    places_.push_back({submap.id, ViewFromAbove::of(submap)});
}

bool PlacesByView::isUnsure(VertexId from, VertexId to, const PlaceKnowledge& knowledge) const
{
    const std::optional<Matrix6d> covariance = knowledge.covariance(from, to);
    return !covariance ||
           covariance->topLeftCorner<3, 3>().diagonal().maxCoeff() > square(config.unsure);
}

std::vector<LoopCandidate> PlacesByView::candidates(
    VertexId id, const PlaceKnowledge& knowledge) const
{
    const auto to = std::lower_bound(
        places_.begin(), places_.end(), id, [](const Place& p, VertexId i) { return p.id < i; });
    const auto tells = [this](const Place& place)
    { return place.view.cells.size() >= static_cast<std::size_t>(config.min_cells); };
    if (to == places_.end() || !tells(*to)) return {};
    Matrix6d covariance = Matrix6d::Zero();
    covariance.diagonal() << square(kShiftSigma), square(kShiftSigma), square(kHeightSigma),
        square(kTurnSigma), square(kTurnSigma), square(kTurnSigma);
    std::vector<std::pair<double, LoopCandidate>> ranked;
    for (auto from = places_.begin(); from != to; ++from)
    {
        if (!tells(*from) || !isUnsure(from->id, id, knowledge)) continue;
        for (const ViewMatch& match : matchViews(from->view, to->view, 2))
            if (match.score >= config.min_score)
                ranked.push_back(
                    {match.score, {from->id, id, match.T_from_to, covariance, "appearance"}});
    }
    std::stable_sort(
        ranked.begin(), ranked.end(),
        [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<LoopCandidate> best;
    for (const auto& [score, candidate] : ranked)
        if (best.size() < static_cast<std::size_t>(config.most)) best.push_back(candidate);
    return best;
}
}  // namespace taut
