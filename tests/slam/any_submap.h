#pragma once

#include "numeric.h"
#include "taut/core/Submap.h"

namespace taut::test
{
/** A submap with something in every field. */
inline Submap anySubmap(VertexId id, int points = 1000, int key_scans = 2)
{
    Random random(static_cast<unsigned>(id) + 1);
    Submap s;
    s.id = id;
    s.T_world_submap = {expSO3(random.vector(1)), random.vector(10)};
    s.up_submap = random.vector(1).normalized();
    for (int i = 0; i < 3; i++) s.up_covariance.col(i) = random.vector(1);
    s.path_begin = 12.5;
    s.path_end = 31.25;
    s.reach = 7;
    s.doubtful = id % 2 == 1;
    for (int i = 0; i < 5; i++)
    {
        Matrix6d covariance;
        for (int k = 0; k < 36; k++) covariance(k / 6, k % 6) = random.normal();
        s.scans.push_back(
            {1'700'000'000'000'000'000 + i,
             {expSO3(random.vector(1)), random.vector(10)},
             covariance});
    }
    for (int i = 0; i < points; i++)
        s.points.push_back({random.vector(9).cast<float>(), static_cast<std::uint16_t>(i % 5)});
    for (int i = 0; i < key_scans; i++)
    {
        KeyScan key;
        key.T_submap_sensor = {expSO3(random.vector(1)), random.vector(10)};
        key.scan = static_cast<std::uint16_t>(2 * i + 1);
        key.blur = 0.1 * i;
        for (int k = 0; k < 500; k++) key.image.add(random.vector(9));
        s.key_scans.push_back(key);
    }
    return s;
}
}  // namespace taut::test
