#include "StreetSide.h"

#include <algorithm>
#include <cmath>

#include "Plants.h"

namespace taut::simulation
{
namespace
{
void addBuilding(Mesh& mesh, const StreetSide& side, double s, double width, Random& random)
{
    const double set_back = random.uniform() < 0.4 ? random.uniform(0.3, 1.5) : 0;
    const int storeys = 2 + static_cast<int>(random.uniform(0, 4));
    const double storey = random.uniform(2.9, 3.4), sill = random.uniform(0.8, 1.1);
    const double below = 1.0, top = storeys * storey + 0.8, depth = 9;
    const double pitch = random.uniform(2.4, 3.4), opening = random.uniform(1.0, 1.5);
    const auto wall = static_cast<float>(random.uniform(0.3, 0.75));

    std::vector<Recess> recesses;
    const int columns = static_cast<int>((width - 1) / pitch);
    const double first = (width - columns * pitch) / 2 + (pitch - opening) / 2;
    const int door = static_cast<int>(random.uniform(0, columns));
    for (int c = 0; c < columns; c++)
        for (int floor = 0; floor < storeys; floor++)
        {
            const double left = first + c * pitch, z = below + floor * storey;
            const bool is_door = floor == 0 && c == door;
            recesses.push_back(
                {left, left + opening, is_door ? z + 0.05 : z + sill, z + 2.3,
                 is_door ? 0.35 : 0.15, 0.15F, false, !is_door});
        }
    // frame() may run against the side: then the facade spans [s, s + width] backwards.
    Pose T = side.frame(s, kFacade + set_back);
    if (T.R.col(0).dot(side.along) < 0) T = side.frame(s + width, kFacade + set_back);
    T.p.z() -= below;
    addWall(mesh, T, width, top + below, recesses, wall);
    const auto at = [&T](double x, double y, double z) { return T * Vector3d(x, y, z); };
    for (const double x : {0.0, width})
        addQuad(
            mesh, at(x, 0, 0), at(x, depth, 0), at(x, depth, top + below), at(x, 0, top + below),
            wall);
    addQuad(  // a roof that slopes up from the street
        mesh, at(0, -0.3, top + below), at(width, -0.3, top + below),
        at(width, depth, top + below + 2.5), at(0, depth, top + below + 2.5), 0.3F);
    for (int floor = 1; floor < storeys && columns > 1; floor++)  // balconies
    {
        if (random.uniform() > 0.35) continue;
        const double left = first + pitch * std::floor(random.uniform(0, columns - 1)) - 0.3;
        const Pose box{T.R, at(left + opening / 2 + 0.3, -0.5, below + floor * storey + 0.45)};
        addBox(mesh, box, {opening + 0.6, 1.0, 1.0}, wall * 0.8F);
    }
}

void addSidewalk(Mesh& mesh, const StreetSide& side)
{
    constexpr double step = 4, kerb = 0.13;
    const Vector3d up(0, 0, kerb), margin(0, 0, 0.3);
    for (double s = 0; s < side.length; s += step)
    {
        const double e = std::min(side.length, s + step);
        const Vector3d a = side.at(s, kKerb), b = side.at(e, kKerb);
        addQuad(
            mesh, a + up, b + up, side.at(e, kFacade + 2) + up, side.at(s, kFacade + 2) + up, 0.4F);
        addQuad(mesh, a - margin, b - margin, b + up, a + up, 0.5F);
    }
}

void parkCars(Movables& cars, const StreetSide& side, Random& random)
{
    for (double s = 14; s < side.length - 16;)
    {
        Pose T = side.frame(s, kParking + random.uniform(-0.15, 0.15));
        T.R = T.R * expSO3(Vector3d(0, 0, random.uniform(-0.03, 0.03)));
        const double scale = random.uniform(0.9, 1.15);
        const auto shade = static_cast<float>(random.uniform(0.1, 0.8));
        cars.add([=](Mesh& mesh, const Pose& place) { addCar(mesh, place, shade, scale); }, T);
        const double gap = random.uniform(5.4, 14.0);
        if (gap > 11) cars.addFreePlace(side.frame(s + gap / 2, kParking));
        s += gap;
    }
}

void addFurniture(Mesh& mesh, const StreetSide& side, Random& random)
{
    for (double s = 18; s < side.length - 14; s += random.uniform(22.0, 30.0))
    {
        const Vector3d foot = side.at(s, kKerb + 0.5), top = foot + Vector3d(0, 0, 6.5);
        addFrustum(mesh, foot, top, 0.1, 0.06, 12, 0.5F);
        addFrustum(mesh, top, top - 1.5 * side.out + Vector3d(0, 0, 0.2), 0.05, 0.05, 8, 0.5F);
    }
    for (double s = 24; s < side.length - 16; s += random.uniform(12.0, 28.0))
        addTree(mesh, side.at(s, kKerb + 1.1), {6, 0.14, 2.6, 1.7, 160}, random);
    for (double s = 16; s < side.length - 16; s += random.uniform(10.0, 25.0))
        addStandingBox(
            mesh, side.at(s, kFacade - 0.9),
            {random.uniform(0.4, 1.2), 0.6, random.uniform(0.8, 1.3)}, random.uniform(-0.2, 0.2),
            0.35F);
}
}  // namespace

Vector3d StreetSide::at(double s, double distance) const
{
    Vector3d p = start + s * along + distance * out;
    p.z() = height(p.x(), p.y());
    return p;
}

Pose StreetSide::frame(double s, double distance) const
{
    Pose T;
    T.R.col(0) = along;
    T.R.col(1) = out;
    T.R.col(2) = Vector3d::UnitZ();
    T.p = at(s, distance);
    if (T.R.determinant() < 0) T.R.col(0) = -along;  // facades to the left: run the other way
    return T;
}

StreetSide outerSide(const Vector3d& from, const Vector3d& to, const Terrain& height)
{
    const Vector3d d = to - from, along = d.normalized(), right(along.y(), -along.x(), 0);
    return {from - kFacade * along, along, right, d.norm() + 2 * kFacade, height};
}

StreetSide innerSide(const Vector3d& from, const Vector3d& to, const Terrain& height)
{
    const Vector3d d = to - from, along = d.normalized(), left(-along.y(), along.x(), 0);
    return {from + kFacade * along, along, left, d.norm() - 2 * kFacade, height};
}

void addStreetSide(Mesh& mesh, const StreetSide& side, Movables& cars, Random& random)
{
    addSidewalk(mesh, side);
    for (double s = 0; s < side.length - 8;)
    {
        const double width = std::min(random.uniform(9.0, 24.0), side.length - s);
        if (random.uniform() > 0.08) addBuilding(mesh, side, s, width, random);
        s += width + (random.uniform() < 0.2 ? random.uniform(2.0, 5.0) : 0);
    }
    parkCars(cars, side, random);
    addFurniture(mesh, side, random);
}
}  // namespace taut::simulation
