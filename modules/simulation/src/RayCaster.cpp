#include "taut/simulation/RayCaster.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "taut/core/Triangle.h"

namespace taut::simulation
{
struct RayCaster::Scene
{
    explicit Scene(Mesh m) : mesh(std::move(m))
    {
        device = rtcNewDevice("threads=1");
        if (!device) throw std::runtime_error("Embree gives no device");
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        fill(geometry);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
        const RTCError error = rtcGetDeviceError(device);
        if (error != RTC_ERROR_NONE)
            throw std::runtime_error("Embree error " + std::to_string(error) + " on a mesh");
    }
    ~Scene()
    {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    void fill(RTCGeometry geometry) const
    {
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
            mesh.vertices.size()));
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Mesh::Triangle),
            mesh.triangles.size()));
        if (!vertices || !indices) throw std::runtime_error("Embree has no memory for the mesh");
        for (const Vector3d& v : mesh.vertices)
            for (int i = 0; i < 3; i++) *vertices++ = static_cast<float>(v[i]);
        for (const Mesh::Triangle& t : mesh.triangles)
            indices = std::copy(t.begin(), t.end(), indices);
    }

    const Vector3d& corner(std::uint32_t triangle, int i) const
    {
        return mesh.vertices[mesh.triangles[triangle][i]];
    }

    Mesh mesh;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
};

RayCaster::RayCaster(Mesh mesh)
{
    if (mesh.triangles.empty()) throw std::invalid_argument("the world has no surfaces");
    scene_ = std::make_unique<Scene>(std::move(mesh));
}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

const Mesh& RayCaster::mesh() const
{
    return scene_->mesh;
}

std::optional<Hit> RayCaster::cast(
    const Vector3d& origin, const Vector3d& direction, double max_range) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray.org_x = static_cast<float>(origin.x());
    query.ray.org_y = static_cast<float>(origin.y());
    query.ray.org_z = static_cast<float>(origin.z());
    query.ray.dir_x = static_cast<float>(direction.x());
    query.ray.dir_y = static_cast<float>(direction.y());
    query.ray.dir_z = static_cast<float>(direction.z());
    query.ray.tfar = static_cast<float>(max_range);
    query.ray.mask = ~0U;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};

    Hit hit;
    hit.triangle = query.hit.primID;
    const Vector3d& a = scene_->corner(hit.triangle, 0);
    const Vector3d& b = scene_->corner(hit.triangle, 1);
    const Vector3d& c = scene_->corner(hit.triangle, 2);
    hit.normal = (b - a).cross(c - a).normalized();
    double cosine = hit.normal.dot(direction);
    if (cosine > 0)
    {
        hit.normal = -hit.normal;
        cosine = -cosine;
    }
    if (cosine > -1e-6) return {};  // along the surface: no return, and no stable intersection
    hit.range = hit.normal.dot(a - origin) / cosine;
    if (!(hit.range > 0 && hit.range <= max_range)) return {};
    hit.reflectivity = scene_->mesh.reflectivity[hit.triangle];
    hit.material = scene_->mesh.materialOf(hit.triangle);
    return hit;
}

double RayCaster::clearance(const Vector3d& point, double max_distance) const
{
    struct Search
    {
        const Scene* scene;
        Vector3d point;
        double best;
    } search{scene_.get(), point, std::numeric_limits<double>::infinity()};

    RTCPointQuery query{};
    query.x = static_cast<float>(point.x());
    query.y = static_cast<float>(point.y());
    query.z = static_cast<float>(point.z());
    query.radius = static_cast<float>(max_distance);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const auto visit = [](RTCPointQueryFunctionArguments* arguments)
    {
        auto& s = *static_cast<Search*>(arguments->userPtr);
        const std::uint32_t t = arguments->primID;
        const Vector3d q = nearestOnTriangle(
            s.point, s.scene->corner(t, 0), s.scene->corner(t, 1), s.scene->corner(t, 2));
        const double distance = (q - s.point).norm();
        if (distance >= s.best) return false;
        s.best = distance;
        if (static_cast<float>(distance) >= arguments->query->radius) return false;
        arguments->query->radius = static_cast<float>(distance);
        return true;
    };
    rtcPointQuery(scene_->scene, &query, &context, visit, &search);
    return search.best <= max_distance ? search.best : std::numeric_limits<double>::infinity();
}
}  // namespace taut::simulation
