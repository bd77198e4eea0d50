#include "taut/session/SecondPass.h"

namespace taut
{
namespace
{
NavState moved(NavState x, const Pose& correction)
{
    x.T_world_imu = correction * x.T_world_imu;
    x.v_world = correction.R * x.v_world;
    return x;
}
}  // namespace

std::vector<SweepRecord> corrected(std::vector<SweepRecord> records, const std::vector<Pose>& path)
{
    for (std::size_t i = 0; i < records.size(); i++)
    {
        SweepRecord& r = records[i];
        const Pose at_begin = path[i] * r.begin.T_world_imu.inverse();
        const Pose at_end = path[i + 1] * r.end.T_world_imu.inverse();
        r.prior_begin = moved(r.prior_begin, at_begin);
        r.begin = moved(r.begin, at_begin);
        r.prior_end = moved(r.prior_end, at_end);
        r.end = moved(r.end, at_end);
    }
    return records;
}

bool undistortAgain(
    MeasurementStream& log, const OdometryConfig& config, const std::vector<SweepRecord>& records,
    MapExport& map, const std::function<bool(double)>& go_on)
{
    std::size_t next = 0;
    SweepReplay replay(
        config,
        [&]() -> std::optional<SweepRecord>
        { return next < records.size() ? std::optional(records[next++]) : std::nullopt; },
        [&](const Sweep& sweep)
        { map.add(sweep.end, sweep.undistorted(sweep.begin, sweep.end), sweep.scan); });
    while (std::optional<Measurement> m = log.next())
    {
        replay.add(std::move(*m));
        if (!go_on(log.progress().fraction())) return false;
    }
    replay.finish();
    return true;
}

void moveSubmaps(
    const Mapper& mapper, const Mapper::Run& run, const std::vector<Pose>& path, MapExport& map)
{
    std::size_t first = 0;  // of the submap, in the path
    for (std::size_t v = run.begin; v < run.end; v++)
    {
        const auto submap = mapper.submap(mapper.graph().vertices[v].id);
        std::vector<std::vector<Vector3d>> by_scan(submap->scans.size());
        for (const SubmapPoint& p : submap->points)
        {
            const Pose T_imu_submap = submap->scans[p.scan].T_submap_imu.inverse();
            const Vector3d in_body = T_imu_submap * Vector3d(p.position.cast<double>());
            by_scan[p.scan].push_back(path[first + p.scan] * in_body);
        }
        for (std::size_t i = 0; i < by_scan.size(); i++)
        {
            NavState at;
            at.t = submap->scans[i].t;
            at.T_world_imu = path[first + i];
            map.add(at, by_scan[i]);
        }
        first += submap->scans.size() - 1;  // the last is the first of the next
    }
}
}  // namespace taut
