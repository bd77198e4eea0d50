#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

/** \file MeshFile.h
 * Triangle meshes in PLY files ("The PLY Polygon File Format", G. Turk, 1994) and OBJ files
 * (Wavefront). */
namespace taut
{
/** A surface of triangles. Without triangles: a cloud of points. */
struct TriangleMesh
{
    using Triangle = std::array<std::uint32_t, 3>;
    std::vector<Eigen::Vector3d> vertices;  //!< [m]
    std::vector<Triangle> triangles;        //!< indices of vertices
};

/** Reads a PLY (text or binary little endian) or OBJ file. Polygons are cut into fans. A file
 * without faces gives its vertices alone. Throws std::runtime_error naming the file and the cause:
 * not there, cut short, a vertex that is not finite, a face of vertices that do not exist. */
TriangleMesh readMesh(const std::string& path);

/** Writes a binary PLY file with coordinates in double precision. `comment`: one line for its
 * header. Throws std::runtime_error naming the file if that fails. */
void writeMesh(const std::string& path, const TriangleMesh& mesh, const std::string& comment);

/** What a file begins with that writeMesh() made with this comment. */
std::string meshFileStart(const std::string& comment);
}  // namespace taut
