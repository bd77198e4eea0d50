#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "taut/files/MeshFile.h"

namespace taut
{
namespace
{
constexpr std::size_t kRowBytes = 3 * sizeof(double);
static_assert(sizeof(Eigen::Vector3d) == kRowBytes);
}  // namespace

std::string meshFileStart(const std::string& comment)
{
    return "ply\nformat binary_little_endian 1.0\ncomment " + comment + "\n";
}

void writeMesh(const std::string& path, const TriangleMesh& mesh, const std::string& comment)
{
    errno = 0;
    std::ofstream out(path, std::ios::binary);
    out << meshFileStart(comment) << "element vertex " << mesh.vertices.size()
        << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
        << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Eigen::Vector3d& v : mesh.vertices)
        out.write(reinterpret_cast<const char*>(v.data()), kRowBytes);
    for (const TriangleMesh::Triangle& t : mesh.triangles)
    {
        out.put(3);
        out.write(reinterpret_cast<const char*>(t.data()), sizeof t);
    }
    out.close();
    if (out) return;
    const std::string cause = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
    throw std::runtime_error("mesh '" + path + "' cannot be written" + cause);
}
}  // namespace taut
