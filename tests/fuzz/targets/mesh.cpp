#include "support.h"
#include "taut/simulation/RayCaster.h"

/* A mesh of the simulator: PLY or OBJ, as its first letter tells. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    const bool is_ply = !input.empty() && *input.data() == 'p';
    const std::string path = folder.write(is_ply ? "a.ply" : "a.obj", input);
    fuzz::readOrRefuse(
        [&]
        {
            const simulation::Mesh mesh = simulation::loadMesh(path, 0.5F);
            fuzz::require(
                mesh.reflectivity.size() == mesh.triangles.size(), "each triangle reflects");
            for (const auto& triangle : mesh.triangles)
                for (const std::uint32_t vertex : triangle)
                    fuzz::require(vertex < mesh.vertices.size(), "corners are there");
            for (const Vector3d& vertex : mesh.vertices)
                fuzz::require(vertex.allFinite(), "vertices are finite");
        });
}
