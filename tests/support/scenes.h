#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "numeric.h"
#include "taut/core/Scan.h"

namespace taut::test
{
/** An axis-aligned box [m]. */
struct Box
{
    Vector3d min, max;
};

/** A room seen from within, with boxes standing in it. */
struct Scene
{
    Box room{{-7, -5, -1.2}, {9, 6, 2.4}};
    std::vector<Box> obstacles;

    /** The same scene with its origin at a point of it. */
    Scene seenFrom(const Vector3d& origin) const
    {
        Scene moved = *this;
        moved.room = {room.min - origin, room.max - origin};
        for (Box& box : moved.obstacles) box = {box.min - origin, box.max - origin};
        return moved;
    }

    /** Distance along a unit direction from the origin to the first wall. */
    double range(const Vector3d& direction) const
    {
        double nearest = leave(room, direction);
        for (const Box& box : obstacles) nearest = std::min(nearest, enter(box, direction));
        return nearest;
    }

 private:
    static double leave(const Box& box, const Vector3d& d)
    {
        double t = 1e9;
        for (int i = 0; i < 3; i++)
            if (d[i] != 0) t = std::min(t, (d[i] > 0 ? box.max[i] : box.min[i]) / d[i]);
        return t;
    }
    static double enter(const Box& box, const Vector3d& d)
    {
        double in = 0, out = 1e9;
        for (int i = 0; i < 3; i++)
        {
            const double a = box.min[i] / d[i], b = box.max[i] / d[i];
            in = std::max(in, std::min(a, b));
            out = std::min(out, std::max(a, b));
        }
        return in < out ? in : 1e9;
    }
};

/** A spinning LiDAR at rest at the origin. */
struct SpinningLidar
{
    int rings = 16, columns = 900;
    double lowest = -15, highest = 15;  //!< elevation of the outer rings [deg]
    double noise = 0.01;                //!< of the range [m]
    Duration period = 100'000'000;      //!< of a turn [ns]

    /** One turn, in the order of time. */
    Scan scan(const Scene& scene, unsigned seed = 1) const
    {
        Random random(seed);
        Scan out;
        out.stamp = 1'700'000'000'000'000'000;
        out.end = out.stamp + period;
        out.rings = rings;
        for (int column = 0; column < columns; column++)
            for (int ring = 0; ring < rings; ring++)
            {
                const Vector3d d = direction(ring, column);
                LidarPoint p;
                p.position = ((scene.range(d) + noise * random.normal()) * d).cast<float>();
                p.offset = static_cast<std::int32_t>(period * column / columns);
                p.ring = static_cast<std::uint16_t>(ring);
                out.points.push_back(p);
            }
        return out;
    }

    Vector3d direction(int ring, int column) const
    {
        const double deg = M_PI / 180;
        const double up =
            deg * (rings > 1 ? lowest + (highest - lowest) * ring / (rings - 1) : 0.0);
        const double around = 2 * M_PI * (column + 0.5) / columns - M_PI;
        return {std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)};
    }
};
}  // namespace taut::test
