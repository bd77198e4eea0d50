#include "FrameGraph.h"

#include <algorithm>
#include <deque>

#include "taut/core/format.h"

namespace taut::bag
{
namespace
{
constexpr std::size_t kMostPairs = 2000;
constexpr double kSameDistance = 1e-3;  // [m]
constexpr double kSameAngle = 1e-3;     // [rad]

struct Difference
{
    double distance = 0, angle = 0;  // [m, rad]

    bool matters() const { return distance > kSameDistance || angle > kSameAngle; }
};

Difference differenceOf(const Pose& a, const Pose& b)
{
    const Pose d = a.inverse() * b;
    return {d.p.norm(), logSO3(d.R).norm()};
}

std::string quoted(const std::string& name)
{
    return "'" + name + "'";
}
}  // namespace

std::string FrameGraph::plainName(const std::string& frame)
{
    return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

bool FrameGraph::add(
    const std::string& parent, const std::string& child, const Pose& T_parent_child)
{
    const std::string a = plainName(parent), b = plainName(child);
    const bool in_order = a < b;
    const Pose T = in_order ? T_parent_child : T_parent_child.inverse();
    const Pair pair = in_order ? Pair(a, b) : Pair(b, a);
    const auto known = edges_.find(pair);
    if (known != edges_.end())
    {
        if (known->second.moves || !differenceOf(known->second.T_first_second, T).matters())
            return false;
        known->second.moves = true;
        return true;
    }
    if (edges_.size() >= kMostPairs) return false;
    edges_[pair] = {T, false};
    neighbours_[a].insert(b);
    neighbours_[b].insert(a);
    return true;
}

FrameGraph::Tree FrameGraph::reach(const std::string& to, bool over_moving) const
{
    Tree tree{{to, {}}};
    std::deque<std::string> waiting{to};
    while (!waiting.empty())
    {
        const std::string at = waiting.front();
        waiting.pop_front();
        const auto neighbours = neighbours_.find(at);
        if (neighbours == neighbours_.end()) continue;
        for (const std::string& next : neighbours->second)
        {
            const bool in_order = at < next;
            const Edge& edge = edges_.at(in_order ? Pair(at, next) : Pair(next, at));
            if ((edge.moves && !over_moving) || tree.count(next) > 0) continue;
            const Pose T_at_next = in_order ? edge.T_first_second : edge.T_first_second.inverse();
            tree[next] = {at, tree.at(at).T_to_frame * T_at_next};
            waiting.push_back(next);
        }
    }
    return tree;
}

/** From the root to the frame. */
std::vector<std::string> FrameGraph::wayTo(const Tree& tree, std::string frame)
{
    std::vector<std::string> way;
    for (; !frame.empty(); frame = tree.at(frame).over) way.push_back(frame);
    std::reverse(way.begin(), way.end());
    return way;
}

/* A pair outside of the tree closes a circle with the ways to its two frames. If what is left of
 * these without their common begin has a part of `way` in it, there is another way. */
std::optional<std::string> FrameGraph::contradiction(
    const Tree& tree, const std::vector<std::string>& way) const
{
    const std::set<std::string> on_way(way.begin() + 1, way.end());
    for (const auto& [pair, edge] : edges_)
    {
        const auto a = tree.find(pair.first), b = tree.find(pair.second);
        if (edge.moves || a == tree.end() || b == tree.end()) continue;
        if (a->second.over == pair.second || b->second.over == pair.first) continue;
        const Difference d =
            differenceOf(a->second.T_to_frame * edge.T_first_second, b->second.T_to_frame);
        if (!d.matters()) continue;
        const auto to_a = wayTo(tree, pair.first), to_b = wayTo(tree, pair.second);
        const auto fork = std::mismatch(to_a.begin(), to_a.end(), to_b.begin(), to_b.end());
        const auto isOnWay = [&](const std::string& frame) { return on_way.count(frame) > 0; };
        if (!std::any_of(fork.first, to_a.end(), isOnWay) &&
            !std::any_of(fork.second, to_b.end(), isOnWay))
            continue;
        return format(
            "two ways from %s to %s differ by %.3g m and %.3g deg (by the transform between %s and "
            "%s)",
            quoted(way.front()).c_str(), quoted(way.back()).c_str(), d.distance,
            d.angle * 180 / M_PI, quoted(pair.first).c_str(), quoted(pair.second).c_str());
    }
    return {};
}

std::string FrameGraph::whyApart(const std::string& to, const std::string& from) const
{
    for (const std::string& frame : {to, from})
        if (neighbours_.count(frame) == 0) return "no transform has the frame " + quoted(frame);
    const Tree all = reach(to, true);
    if (all.count(from) == 0)
        return "no chain of transforms joins " + quoted(to) + " and " + quoted(from);
    const auto way = wayTo(all, from);
    for (std::size_t i = 1; i < way.size(); i++)
    {
        const Pair pair(std::min(way[i - 1], way[i]), std::max(way[i - 1], way[i]));
        if (edges_.at(pair).moves)
            return "the transform between " + quoted(way[i - 1]) + " and " + quoted(way[i]) +
                   " changes";
    }
    return "no chain of transforms that stay joins " + quoted(to) + " and " + quoted(from);
}

FrameGraph::Answer FrameGraph::find(const std::string& to_name, const std::string& from_name) const
{
    const std::string to = plainName(to_name), from = plainName(from_name);
    Answer answer;
    const Tree tree = reach(to, false);
    const auto reached = tree.find(from);
    if (reached == tree.end())
    {
        answer.cause = whyApart(to, from);
        return answer;
    }
    const auto way = wayTo(tree, from);
    if (const auto cause = contradiction(tree, way))
    {
        answer.cause = *cause;
        return answer;
    }
    answer.T_to_from = reached->second.T_to_frame;
    for (const std::string& frame : way) answer.way += (answer.way.empty() ? "" : " <- ") + frame;
    return answer;
}
}  // namespace taut::bag
