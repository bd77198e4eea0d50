#include "taut/places/ViewFromAbove.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace taut
{
namespace
{
constexpr int kBands = 12;
constexpr int kUpright = 3;         // occupied bands of a cell in which something stands
constexpr double kGroundReach = 3;  // [m] around a cell, where its ground is looked for
constexpr std::size_t kMostCells = 500;
constexpr std::size_t kTurns = 8;     // that are tried, each with its opposite
constexpr double kPeakApart = 2;      // [m] two matches of one turn are further apart
constexpr std::size_t kRanked = 200;  // shifts among which these are looked for
constexpr double kAlike = 0.6;        // least share of common bands of two cells that are alike

using Key = std::pair<int, int>;

struct Column
{
    std::vector<Eigen::Vector3f> points;
    float lowest = 1e9F;
};

std::map<Key, Column> columnsOf(const Submap& submap)
{
    std::map<Key, Column> columns;
    for (const SubmapPoint& p : submap.points)
    {
        const Key key{
            static_cast<int>(std::floor(p.position.x() / ViewFromAbove::kCell)),
            static_cast<int>(std::floor(p.position.y() / ViewFromAbove::kCell))};
        Column& column = columns[key];
        column.points.push_back(p.position);
        column.lowest = std::min(column.lowest, p.position.z());
    }
    return columns;
}

/** The lowest point around. */
float groundAt(const std::map<Key, Column>& columns, const Key& key)
{
    constexpr int reach = static_cast<int>(kGroundReach / ViewFromAbove::kCell);
    float lowest = 1e9F;
    for (int x = key.first - reach; x <= key.first + reach; x++)
        for (auto it = columns.lower_bound({x, key.second - reach});
             it != columns.end() && it->first.first == x && it->first.second <= key.second + reach;
             ++it)
            lowest = std::min(lowest, it->second.lowest);
    return lowest;
}

int bits(unsigned profile)
{
    return __builtin_popcount(profile);
}

bool areAlike(std::uint16_t a, std::uint16_t b)
{
    const int common = bits(a & b), all = bits(a | b);
    return common >= kAlike * all;
}

/** Direction of the points of a wall, 0 to pi; negative: they are no wall. */
double wallDirection(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector2f& middle)
{
    double xx = 0, xy = 0, yy = 0;
    for (const Eigen::Vector3f& p : points)
    {
        const Eigen::Vector2d d = (p.head<2>() - middle).cast<double>();
        xx += d.x() * d.x();
        xy += d.x() * d.y();
        yy += d.y() * d.y();
    }
    const double half = (xx + yy) / 2, root = std::hypot((xx - yy) / 2, xy);
    if (half <= 0 || half - root > 0.1 * (half + root)) return -1;
    double direction = 0.5 * std::atan2(2 * xy, xx - yy);
    if (direction < 0) direction += M_PI;
    return direction;
}

/** Turns [rad] by which the walls of `to` run as those of `from` do, the best first. */
std::vector<double> likelyTurns(const ViewFromAbove& from, const ViewFromAbove& to)
{
    constexpr int n = ViewFromAbove::kDirections;
    std::array<double, n> agreement{};
    for (int turn = 0; turn < n; turn++)
        for (int i = 0; i < n; i++)
            agreement[static_cast<std::size_t>(turn)] +=
                static_cast<double>(from.directions[static_cast<std::size_t>((i + turn) % n)]) *
                static_cast<double>(to.directions[static_cast<std::size_t>(i)]);
    std::vector<int> order(n);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(
        order.begin(), order.end(),
        [&](int a, int b) {
            return agreement[static_cast<std::size_t>(a)] > agreement[static_cast<std::size_t>(b)];
        });
    std::vector<double> turns;
    for (std::size_t i = 0; i < kTurns; i++)
    {
        const double turn = order[i] * M_PI / n;
        turns.push_back(turn);
        turns.push_back(turn + M_PI);
    }
    return turns;
}

/** Votes of pairs of cells for the shift between two views after a turn. */
class ShiftVotes
{
 public:
    ShiftVotes(
        const ViewFromAbove& from, const std::vector<Eigen::Vector2d>& turned,
        const ViewFromAbove& to)
    {
        for (std::size_t i = 0; i < to.cells.size(); i++)
            for (const ViewFromAbove::Cell& cell : from.cells)
            {
                if (!areAlike(cell.profile, to.cells[i].profile)) continue;
                const Eigen::Vector2d shift = cell.middle.cast<double>() - turned[i];
                const int x = static_cast<int>(std::lround(shift.x())) + kHalf;
                const int y = static_cast<int>(std::lround(shift.y())) + kHalf;
                if (x < 1 || y < 1 || x >= kSize - 1 || y >= kSize - 1) continue;
                votes_[static_cast<std::size_t>(y * kSize + x)]++;
            }
    }

    /** The shifts with the most votes of 3 x 3 cells around. */
    std::vector<std::pair<int, Eigen::Vector2d>> best(std::size_t most) const
    {
        std::vector<std::pair<int, int>> ranked;  // votes, place
        for (int y = 1; y < kSize - 1; y++)
            for (int x = 1; x < kSize - 1; x++)
            {
                const int at = y * kSize + x;
                if (votes_[static_cast<std::size_t>(at)] == 0) continue;
                int sum = 0;
                for (const int dy : {-kSize, 0, kSize})
                    for (const int dx : {-1, 0, 1})
                        sum += votes_[static_cast<std::size_t>(at + dy + dx)];
                ranked.emplace_back(-sum, at);
            }
        const std::size_t first = std::min<std::size_t>(ranked.size(), kRanked);
        std::partial_sort(
            ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(first), ranked.end());
        ranked.resize(first);
        std::vector<std::pair<int, Eigen::Vector2d>> shifts;
        for (const auto& [votes, at] : ranked)
        {
            if (shifts.size() == most) break;
            const Eigen::Vector2d shift(at % kSize - kHalf, at / kSize - kHalf);
            const bool known = std::any_of(
                shifts.begin(), shifts.end(),
                [&](const auto& s) { return (s.second - shift).norm() <= kPeakApart; });
            if (!known) shifts.emplace_back(-votes, shift);
        }
        return shifts;
    }

 private:
    static constexpr int kHalf = 128, kSize = 2 * kHalf;  // [m]
    std::vector<int> votes_ = std::vector<int>(static_cast<std::size_t>(kSize) * kSize, 0);
};

/** How well the views lie on each other, cell by cell; tells the height between them too. */
ViewMatch judged(
    const ViewFromAbove& from, const std::vector<Eigen::Vector2d>& turned, const ViewFromAbove& to,
    double turn, const Eigen::Vector2d& shift)
{
    std::vector<double> heights;
    const ViewFromAbove::Cell* const begin = from.cells.data();
    const ViewFromAbove::Cell* const end = begin + from.cells.size();
    for (std::size_t i = 0; i < to.cells.size(); i++)
    {
        const Eigen::Vector2d at = turned[i] + shift;
        const int x = static_cast<int>(std::floor(at.x())),
                  y = static_cast<int>(std::floor(at.y()));
        const ViewFromAbove::Cell* alike = nullptr;
        for (int cx = x - 1; cx <= x + 1 && alike == nullptr; cx++)
        {
            const auto* it = std::lower_bound(
                begin, end, std::make_pair(cx, y - 1),
                [](const ViewFromAbove::Cell& c, const std::pair<int, int>& k)
                { return std::make_pair<int, int>(c.x, c.y) < k; });
            for (; it != end && it->x == cx && it->y <= y + 1; ++it)
                if (areAlike(it->profile, to.cells[i].profile) &&
                    (it->middle.cast<double>() - at).norm() < 1)
                    alike = it;
        }
        if (alike != nullptr)
            heights.push_back(static_cast<double>(alike->ground - to.cells[i].ground));
    }
    ViewMatch match;
    const std::size_t smaller = std::min(from.cells.size(), to.cells.size());
    if (heights.empty() || smaller == 0) return match;
    const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
    std::nth_element(heights.begin(), middle, heights.end());
    match.T_from_to = {expSO3({0, 0, turn}), {shift.x(), shift.y(), *middle}};
    match.score = std::min(1.0, static_cast<double>(heights.size()) / static_cast<double>(smaller));
    return match;
}
}  // namespace

ViewFromAbove ViewFromAbove::of(const Submap& submap)
{
    ViewFromAbove view;
    const std::map<Key, Column> columns = columnsOf(submap);
    double walls = 0;
    for (const auto& [key, column] : columns)
    {
        Cell cell;
        cell.ground = groundAt(columns, key);
        Eigen::Vector2f sum = Eigen::Vector2f::Zero();
        for (const Eigen::Vector3f& p : column.points)
        {
            const int band = static_cast<int>((p.z() - cell.ground) / static_cast<float>(kBand));
            if (band >= 0 && band < kBands)
                cell.profile = static_cast<std::uint16_t>(cell.profile | 1 << band);
            sum += p.head<2>();
        }
        if (bits(cell.profile) < kUpright) continue;
        cell.x = static_cast<std::int16_t>(key.first);
        cell.y = static_cast<std::int16_t>(key.second);
        cell.middle = sum / static_cast<float>(column.points.size());
        view.cells.push_back(cell);
        const double direction = wallDirection(column.points, cell.middle);
        if (direction < 0) continue;
        const int bin = static_cast<int>(direction / M_PI * kDirections) % kDirections;
        view.directions[static_cast<std::size_t>(bin)] += 1;
        walls++;
    }
    if (walls > 0)
        for (float& d : view.directions) d /= static_cast<float>(walls);
    if (view.cells.size() > kMostCells)  // the nearest tell most
    {
        std::stable_sort(
            view.cells.begin(), view.cells.end(),
            [](const Cell& a, const Cell& b)
            { return a.middle.squaredNorm() < b.middle.squaredNorm(); });
        view.cells.resize(kMostCells);
        std::sort(
            view.cells.begin(), view.cells.end(),
            [](const Cell& a, const Cell& b)
            { return std::make_pair(a.x, a.y) < std::make_pair(b.x, b.y); });
    }
    return view;
}

std::vector<ViewMatch> matchViews(
    const ViewFromAbove& from, const ViewFromAbove& to, std::size_t most)
{
    std::vector<ViewMatch> matches;
    for (const double turn : likelyTurns(from, to))
    {
        const Eigen::Matrix2d R = expSO3({0, 0, turn}).topLeftCorner<2, 2>();
        std::vector<Eigen::Vector2d> turned;
        turned.reserve(to.cells.size());
        for (const ViewFromAbove::Cell& cell : to.cells)
            turned.emplace_back(R * cell.middle.cast<double>());
        for (const auto& [votes, shift] : ShiftVotes(from, turned, to).best(2))
        {
            const ViewMatch match = judged(from, turned, to, turn, shift);
            if (match.score > 0) matches.push_back(match);
        }
    }
    std::stable_sort(
        matches.begin(), matches.end(),
        [](const ViewMatch& a, const ViewMatch& b) { return a.score > b.score; });
    std::vector<ViewMatch> best;
    for (const ViewMatch& match : matches)
    {
        if (best.size() == most) break;
        const bool known = std::any_of(
            best.begin(), best.end(),
            [&](const ViewMatch& b)
            {
                return (b.T_from_to.p - match.T_from_to.p).norm() < kPeakApart &&
                       logSO3(b.T_from_to.R.transpose() * match.T_from_to.R).norm() < 0.2;
            });
        if (!known) best.push_back(match);
    }
    return best;
}
}  // namespace taut
