#include "taut/evaluation/TrueSurface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "taut/core/Triangle.h"
#include "taut/evaluation/PointGrid.h"

namespace taut
{
namespace
{
constexpr std::uint32_t kLeaf = 4;  // elements of a leaf at most
constexpr std::size_t kSpacingSamples = 2000;
constexpr double kNormalRadius = 4;       // in spacings of a cloud
constexpr std::size_t kNormalPoints = 5;  // of a cloud, at least

double distance2(const Vector3d& p, const Vector3d& min, const Vector3d& max)
{
    return (min - p).cwiseMax(p - max).cwiseMax(0.0).squaredNorm();
}
}  // namespace

TrueSurface::TrueSurface(TriangleMesh mesh) : mesh_(std::move(mesh))
{
    if (mesh_.vertices.empty()) throw std::runtime_error("the true surface is empty");
    if (size() >= (std::size_t{1} << 31))
        throw std::invalid_argument("the true surface is too large");
    build();
    for (std::uint32_t i = 0; !isCloud() && i < size(); i++)
        area_ += (corner(i, 1) - corner(i, 0)).cross(corner(i, 2) - corner(i, 0)).norm() / 2;
    if (!isCloud() && !(area_ > 0)) throw std::runtime_error("the true surface has no area");
    if (!isCloud() || size() < 2) return;
    std::vector<double> spacings;
    const std::size_t stride = 1 + size() / kSpacingSamples;
    for (std::size_t i = 0; i < size(); i += stride)
    {
        Nearest best;
        search(mesh_.vertices[i], best, [i](std::uint32_t element) { return element == i; });
        spacings.push_back(best.distance);
    }
    std::nth_element(spacings.begin(), spacings.begin() + spacings.size() / 2, spacings.end());
    spacing_ = spacings[spacings.size() / 2];
}

void TrueSurface::build()
{
    const auto count = static_cast<std::uint32_t>(size());
    elements_.resize(count);
    std::iota(elements_.begin(), elements_.end(), 0U);
    centres_.resize(count);
    for (std::uint32_t i = 0; i < count; i++)
        centres_[i] = isCloud() ? corner(i, 0) : (corner(i, 0) + corner(i, 1) + corner(i, 2)) / 3;
    nodes_.reserve(count / 2 + 1);
    nodes_.emplace_back();
    split(0, 0, count);
    centres_ = {};
}

/** Halves the elements along the longest side of the box around their centres. */
void TrueSurface::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end)
{
    Vector3d min = Vector3d::Constant(std::numeric_limits<double>::infinity()), max = -min;
    Vector3d centre_min = min, centre_max = max;
    for (std::uint32_t k = begin; k < end; k++)
    {
        const std::uint32_t element = elements_[k];
        for (int i = 0; i < (isCloud() ? 1 : 3); i++)
        {
            min = min.cwiseMin(corner(element, i));
            max = max.cwiseMax(corner(element, i));
        }
        centre_min = centre_min.cwiseMin(centres_[element]);
        centre_max = centre_max.cwiseMax(centres_[element]);
    }
    nodes_[node].min = min;
    nodes_[node].max = max;
    if (end - begin <= kLeaf)
    {
        nodes_[node].begin = begin;
        nodes_[node].count = end - begin;
        return;
    }
    int axis = 0;
    (centre_max - centre_min).maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(
        elements_.begin() + begin, elements_.begin() + middle, elements_.begin() + end,
        [&](std::uint32_t a, std::uint32_t b) { return centres_[a][axis] < centres_[b][axis]; });
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].begin = child;
    nodes_.resize(nodes_.size() + 2);
    split(child, begin, middle);
    split(child + 1, middle, end);
}

Vector3d TrueSurface::nearestOn(std::uint32_t element, const Vector3d& p) const
{
    if (isCloud()) return mesh_.vertices[element];
    return nearestOnTriangle(p, corner(element, 0), corner(element, 1), corner(element, 2));
}

template <class Skip>
void TrueSurface::search(const Vector3d& p, Nearest& best, const Skip& skip) const
{
    struct Open
    {
        std::uint32_t node;
        double distance2;
    };
    std::array<Open, 64> stack;  // the tree is halved at most 31 times
    std::size_t open = 0;
    double best2 = best.distance * best.distance;
    stack[open++] = {0, distance2(p, nodes_[0].min, nodes_[0].max)};
    while (open > 0)
    {
        const Open top = stack[--open];
        if (top.distance2 >= best2) continue;
        const Node& node = nodes_[top.node];
        if (node.count == 0)
        {
            const Node &a = nodes_[node.begin], &b = nodes_[node.begin + 1];
            Open first{node.begin, distance2(p, a.min, a.max)};
            Open second{node.begin + 1, distance2(p, b.min, b.max)};
            if (second.distance2 < first.distance2) std::swap(first, second);
            stack[open++] = second;
            stack[open++] = first;  // the nearer one is looked at first
            continue;
        }
        for (std::uint32_t k = node.begin; k < node.begin + node.count; k++)
        {
            if (skip(elements_[k])) continue;
            const Vector3d q = nearestOn(elements_[k], p);
            const double d2 = (q - p).squaredNorm();
            if (d2 >= best2) continue;
            best2 = d2;
            best = {elements_[k], q, std::sqrt(d2)};
        }
    }
}

TrueSurface::Nearest TrueSurface::nearest(
    const Vector3d& p, double bound, std::uint32_t guess) const
{
    Nearest best;
    best.distance = bound;
    if (guess < size())
    {
        const Vector3d q = nearestOn(guess, p);
        if ((q - p).norm() < bound) best = {guess, q, (q - p).norm()};
    }
    search(p, best, [](std::uint32_t) { return false; });
    if (best.element == Nearest::kNone) best.distance = std::numeric_limits<double>::infinity();
    return best;
}

void TrueSurface::collect(const Vector3d& p, double radius, std::vector<Vector3d>& points) const
{
    std::array<std::uint32_t, 64> stack;
    std::size_t open = 0;
    stack[open++] = 0;
    while (open > 0)
    {
        const Node& node = nodes_[stack[--open]];
        if (distance2(p, node.min, node.max) > radius * radius) continue;
        if (node.count == 0)
        {
            stack[open++] = node.begin;
            stack[open++] = node.begin + 1;
            continue;
        }
        for (std::uint32_t k = node.begin; k < node.begin + node.count; k++)
            if ((corner(elements_[k], 0) - p).squaredNorm() <= radius * radius)
                points.push_back(corner(elements_[k], 0));
    }
}

Vector3d TrueSurface::normalOf(std::uint32_t element) const
{
    if (!isCloud())
    {
        const Vector3d a = corner(element, 0);
        const Vector3d n = (corner(element, 1) - a).cross(corner(element, 2) - a);
        return n.norm() > 0 ? Vector3d(n.normalized()) : Vector3d(Vector3d::Zero());
    }
    std::vector<Vector3d> points;
    collect(corner(element, 0), kNormalRadius * spacing_, points);
    if (points.size() < kNormalPoints) return Vector3d::Zero();
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& q : points) mean += q / static_cast<double>(points.size());
    Matrix3d covariance = Matrix3d::Zero();
    for (const Vector3d& q : points) covariance += (q - mean) * (q - mean).transpose();
    return Eigen::SelfAdjointEigenSolver<Matrix3d>(covariance).eigenvectors().col(0);
}

std::vector<Vector3d> TrueSurface::samples(std::size_t count, double cell) const
{
    std::vector<Vector3d> samples;
    if (isCloud())
    {
        std::vector<Eigen::Vector3f> points;
        points.reserve(size());
        const Vector3d origin = mesh_.vertices[0];  // far from zero, floats are coarse
        for (const Vector3d& v : mesh_.vertices) points.push_back((v - origin).cast<float>());
        const PointGrid grid(points, cell);
        const std::size_t stride = (grid.cells() + count - 1) / count;
        for (std::size_t i = 0; i < grid.cells(); i += stride)
            samples.push_back(origin + grid.points()[grid.pointsOf(i).first].cast<double>());
        return samples;
    }
    samples.reserve(count + 1);
    // Steps of equal area along the triangles; within each, the points of a lattice that fills a
    // square evenly (steps of the plastic number), folded to the triangle.
    const double step = area_ / static_cast<double>(count);
    constexpr double kPlastic = 1.32471795724474602596;
    double due = step / 2, u = 0.5, v = 0.5;
    for (std::uint32_t i = 0; i < size(); i++)
    {
        const Vector3d a = corner(i, 0), ab = corner(i, 1) - a, ac = corner(i, 2) - a;
        double left = ab.cross(ac).norm() / 2;
        for (; due <= left; due += step)
        {
            u = std::fmod(u + 1 / kPlastic, 1);
            v = std::fmod(v + 1 / (kPlastic * kPlastic), 1);
            const bool folded = u + v > 1;
            samples.push_back(a + (folded ? 1 - u : u) * ab + (folded ? 1 - v : v) * ac);
        }
        due -= left;
    }
    return samples;
}
}  // namespace taut
