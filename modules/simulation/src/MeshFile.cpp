#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "taut/simulation/Mesh.h"

namespace taut::simulation
{
namespace
{
[[noreturn]] void fail(const std::string& path, const std::string& what)
{
    throw std::runtime_error("mesh '" + path + "': " + what);
}

/** Adds a polygon as a fan. */
void addPolygon(
    Mesh& mesh, const std::vector<std::int64_t>& corners, float reflectivity,
    const std::string& path)
{
    for (const std::int64_t c : corners)
        if (c < 0 || c >= static_cast<std::int64_t>(mesh.vertices.size()))
            fail(path, "a face names vertex " + std::to_string(c) + " which does not exist");
    for (std::size_t i = 2; i < corners.size(); i++)
    {
        mesh.triangles.push_back(
            {static_cast<std::uint32_t>(corners[0]), static_cast<std::uint32_t>(corners[i - 1]),
             static_cast<std::uint32_t>(corners[i])});
        mesh.reflectivity.push_back(reflectivity);
    }
}

Mesh loadObj(std::istream& file, float reflectivity, const std::string& path)
{
    Mesh mesh;
    std::string line;
    for (int number = 1; std::getline(file, line); number++)
    {
        std::istringstream s(line);
        std::string kind;
        s >> kind;
        if (kind == "v")
        {
            Vector3d v;
            if (!(s >> v.x() >> v.y() >> v.z()))
                fail(path, "line " + std::to_string(number) + " is no vertex");
            mesh.vertices.push_back(v);
        }
        else if (kind == "f")
        {
            std::vector<std::int64_t> corners;
            for (std::string word; s >> word;)  // vertex, vertex/texture, vertex//normal...
            {
                const long index = std::strtol(word.c_str(), nullptr, 10);
                const auto count = static_cast<std::int64_t>(mesh.vertices.size());
                corners.push_back(index < 0 ? count + index : index - 1);
            }
            addPolygon(mesh, corners, reflectivity, path);
        }
    }
    return mesh;
}

struct PlyProperty
{
    std::string name, type, count_type;  // count_type: of a list, else empty
};
struct PlyElement
{
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
};

template <class T>
double binaryAs(std::istream& file)
{
    T value{};
    file.read(reinterpret_cast<char*>(&value), sizeof(T));
    return static_cast<double>(value);
}

/** One number of a PLY file, text or binary. */
double plyNumber(std::istream& file, const std::string& type, bool text, const std::string& path)
{
    double value = 0;
    if (text)
        file >> value;
    else if (type == "float" || type == "float32")
        value = binaryAs<float>(file);
    else if (type == "double" || type == "float64")
        value = binaryAs<double>(file);
    else if (type == "uchar" || type == "uint8")
        value = binaryAs<std::uint8_t>(file);
    else if (type == "char" || type == "int8")
        value = binaryAs<std::int8_t>(file);
    else if (type == "ushort" || type == "uint16")
        value = binaryAs<std::uint16_t>(file);
    else if (type == "short" || type == "int16")
        value = binaryAs<std::int16_t>(file);
    else if (type == "uint" || type == "uint32")
        value = binaryAs<std::uint32_t>(file);
    else if (type == "int" || type == "int32")
        value = binaryAs<std::int32_t>(file);
    else
        fail(path, "unknown type '" + type + "'");
    if (!file) fail(path, "it ends early");
    return value;
}

std::vector<PlyElement> plyHeader(std::istream& file, bool& text, const std::string& path)
{
    std::vector<PlyElement> elements;
    std::string line, word;
    while (std::getline(file, line))
    {
        std::istringstream s(line);
        if (!(s >> word)) continue;
        if (word == "end_header") return elements;
        if (word == "format")
        {
            s >> word;
            text = word == "ascii";
            if (!text && word != "binary_little_endian")
                fail(path, "format '" + word + "' is not supported");
        }
        else if (word == "element")
        {
            elements.emplace_back();
            if (!(s >> elements.back().name >> elements.back().count))
                fail(path, "its header has an element without a name or a number");
        }
        else if (word == "property" && !elements.empty())
        {
            PlyProperty p;
            s >> p.type;
            if (p.type == "list") s >> p.count_type >> p.type;
            s >> p.name;
            elements.back().properties.push_back(p);
        }
    }
    fail(path, "its header has no end");
}

/** The number of a vertex; -1 for what can be none. */
std::int64_t vertexNumber(double value)
{
    constexpr double kMost = 4294967295.0;
    return value >= 0 && value <= kMost ? static_cast<std::int64_t>(value) : -1;
}

Mesh loadPly(std::istream& file, float reflectivity, const std::string& path)
{
    bool text = true;
    Mesh mesh;
    for (const PlyElement& element : plyHeader(file, text, path))
    {
        // Any number of them would fit into the file.
        if (element.count > 0 && element.properties.empty())
            fail(path, "its element '" + element.name + "' has no properties");
        for (std::size_t i = 0; i < element.count; i++)
        {
            std::map<std::string, double> scalars;
            std::vector<std::int64_t> corners;
            for (const PlyProperty& p : element.properties)
            {
                if (p.count_type.empty())
                {
                    scalars[p.name] = plyNumber(file, p.type, text, path);
                    continue;
                }
                const double count = plyNumber(file, p.count_type, text, path);
                for (double k = 0; k < count; k++)
                {
                    const double value = plyNumber(file, p.type, text, path);
                    if (p.name == "vertex_indices" || p.name == "vertex_index")
                        corners.push_back(vertexNumber(value));
                }
            }
            if (element.name == "vertex")
                mesh.vertices.emplace_back(scalars["x"], scalars["y"], scalars["z"]);
            else if (element.name == "face")
                addPolygon(mesh, corners, reflectivity, path);
        }
    }
    return mesh;
}
}  // namespace

Mesh loadMesh(const std::string& path, float reflectivity)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read the mesh '" + path + "'");
    std::string first;
    std::getline(file, first);
    const bool ply = first.rfind("ply", 0) == 0;
    if (!ply) file.seekg(0);
    Mesh mesh = ply ? loadPly(file, reflectivity, path) : loadObj(file, reflectivity, path);
    for (const Vector3d& v : mesh.vertices)
        if (!v.allFinite()) fail(path, "a vertex is not finite");
    if (mesh.triangles.empty()) fail(path, "it has no faces (is it a PLY or OBJ file?)");
    return mesh;
}
}  // namespace taut::simulation
