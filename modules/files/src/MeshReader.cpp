#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "numbers.h"
#include "taut/files/MeshFile.h"

namespace taut
{
namespace
{
[[noreturn]] void fail(const std::string& path, const std::string& what)
{
    throw std::runtime_error("mesh '" + path + "': " + what);
}

/** Adds a polygon as a fan. */
void addPolygon(
    TriangleMesh& mesh, const std::vector<std::int64_t>& corners, const std::string& path)
{
    for (const std::int64_t c : corners)
        if (c < 0 || c >= static_cast<std::int64_t>(mesh.vertices.size()))
            fail(path, "a face names vertex " + std::to_string(c) + " which does not exist");
    for (std::size_t i = 2; i < corners.size(); i++)
        mesh.triangles.push_back(
            {static_cast<std::uint32_t>(corners[0]), static_cast<std::uint32_t>(corners[i - 1]),
             static_cast<std::uint32_t>(corners[i])});
}

TriangleMesh readObj(std::istream& file, const std::string& path)
{
    TriangleMesh mesh;
    std::vector<std::int64_t> corners;
    std::string line;
    for (int number = 1; std::getline(file, line); number++)
    {
        std::istringstream s(line);
        std::string kind;
        s >> kind;
        if (kind == "v")
        {
            Eigen::Vector3d v;
            if (!(s >> v.x() >> v.y() >> v.z()))
                fail(path, "line " + std::to_string(number) + " is no vertex");
            mesh.vertices.push_back(v);
        }
        else if (kind == "f")
        {
            corners.clear();
            for (std::string word; s >> word;)  // vertex, vertex/texture, vertex//normal...
            {
                const long index = std::strtol(word.c_str(), nullptr, 10);
                const auto count = static_cast<std::int64_t>(mesh.vertices.size());
                corners.push_back(index < 0 ? count + index : index - 1);
            }
            addPolygon(mesh, corners, path);
        }
    }
    return mesh;
}

using Decoder = double (*)(const char*);

/** A type of numbers: its size and how it is read. */
struct PlyType
{
    std::streamsize bytes = 0;
    Decoder decode = nullptr;
};

PlyType plyType(const std::string& name, const std::string& path)
{
    static const std::map<std::string, PlyType> types{
        {"float", {4, valueAt<float>}},          {"float32", {4, valueAt<float>}},
        {"double", {8, valueAt<double>}},        {"float64", {8, valueAt<double>}},
        {"uchar", {1, valueAt<std::uint8_t>}},   {"uint8", {1, valueAt<std::uint8_t>}},
        {"char", {1, valueAt<std::int8_t>}},     {"int8", {1, valueAt<std::int8_t>}},
        {"ushort", {2, valueAt<std::uint16_t>}}, {"uint16", {2, valueAt<std::uint16_t>}},
        {"short", {2, valueAt<std::int16_t>}},   {"int16", {2, valueAt<std::int16_t>}},
        {"uint", {4, valueAt<std::uint32_t>}},   {"uint32", {4, valueAt<std::uint32_t>}},
        {"int", {4, valueAt<std::int32_t>}},     {"int32", {4, valueAt<std::int32_t>}}};
    const auto it = types.find(name);
    if (it == types.end()) fail(path, "unknown type '" + name + "'");
    return it->second;
}

struct PlyProperty
{
    std::string name;
    PlyType type;
    bool list = false;
    PlyType count_type;  // of a list
};
struct PlyElement
{
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;

    /** -1 if there is none. */
    int find(const std::string& property) const
    {
        for (std::size_t i = 0; i < properties.size(); i++)
            if (properties[i].name == property) return static_cast<int>(i);
        return -1;
    }
};

/** The numbers of a PLY file one by one, text or binary. */
class PlyNumbers
{
 public:
    PlyNumbers(std::istream& file, const std::string& path) : file_(file), path_(path) {}

    std::vector<PlyElement> header()
    {
        std::vector<PlyElement> elements;
        std::string line, word;
        while (std::getline(file_, line))
        {
            std::istringstream s(line);
            if (!(s >> word)) continue;
            if (word == "end_header") return elements;
            if (word == "format")
            {
                s >> word;
                text_ = word == "ascii";
                if (!text_ && word != "binary_little_endian")
                    fail(path_, "format '" + word + "' is not supported");
            }
            else if (word == "element")
            {
                elements.emplace_back();
                if (!(s >> elements.back().name >> elements.back().count))
                    fail(
                        path_,
                        "its header has an element without a name or a number: '" + line + "'");
            }
            else if (word == "property" && !elements.empty())
            {
                PlyProperty p;
                std::string type, count_type;
                s >> type;
                p.list = type == "list";
                if (p.list) s >> count_type >> type;
                s >> p.name;
                p.type = plyType(type, path_);
                if (p.list) p.count_type = plyType(count_type, path_);
                elements.back().properties.push_back(p);
            }
        }
        fail(path_, "its header has no end");
    }

    double next(const PlyType& type)
    {
        double value = 0;
        if (text_)
        {
            file_ >> word_;  // operator>> for a double knows no "nan"
            const char* begin = word_.data() + (!word_.empty() && word_[0] == '+' ? 1 : 0);
            const char* end = word_.data() + word_.size();
            const auto result = std::from_chars(begin, end, value);
            if (file_ && (result.ec != std::errc{} || result.ptr != end))
                fail(path_, "'" + word_ + "' is no number");
        }
        else
        {
            std::array<char, 8> bytes{};
            file_.read(bytes.data(), type.bytes);
            value = type.decode(bytes.data());
        }
        if (!file_) fail(path_, "it ends early");
        return value;
    }

 private:
    std::istream& file_;
    const std::string& path_;
    std::string word_;
    bool text_ = true;
};

/** The number of a vertex; -1 for what can be none. */
std::int64_t vertexNumber(double value)
{
    constexpr double kMost = 4294967295.0;
    return value >= 0 && value <= kMost ? static_cast<std::int64_t>(value) : -1;
}

TriangleMesh readPly(std::istream& file, const std::string& path)
{
    PlyNumbers numbers(file, path);
    TriangleMesh mesh;
    for (const PlyElement& element : numbers.header())
    {
        // Any number of them would fit into the file.
        if (element.count > 0 && element.properties.empty())
            fail(path, "its element '" + element.name + "' has no properties");
        const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
        const std::array<int, 3> xyz{element.find("x"), element.find("y"), element.find("z")};
        for (const int column : xyz)
            if (is_vertex && column < 0) fail(path, "its vertices lack x, y or z");
        const int indices = std::max(element.find("vertex_indices"), element.find("vertex_index"));
        std::vector<double> scalars(element.properties.size());
        std::vector<std::int64_t> corners;
        for (std::size_t i = 0; i < element.count; i++)
        {
            corners.clear();
            for (std::size_t k = 0; k < element.properties.size(); k++)
            {
                const PlyProperty& p = element.properties[k];
                const double count = p.list ? numbers.next(p.count_type) : 1;
                for (double n = 0; n < count; n++)
                {
                    scalars[k] = numbers.next(p.type);
                    if (static_cast<int>(k) == indices && p.list)
                        corners.push_back(vertexNumber(scalars[k]));
                }
            }
            if (is_vertex)
                mesh.vertices.emplace_back(scalars[xyz[0]], scalars[xyz[1]], scalars[xyz[2]]);
            else if (is_face)
                addPolygon(mesh, corners, path);
        }
    }
    return mesh;
}
}  // namespace

TriangleMesh readMesh(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read the mesh '" + path + "'");
    std::string first;
    std::getline(file, first);
    const bool ply = first.rfind("ply", 0) == 0;
    if (!ply)
    {
        file.clear();  // it may have a single line
        file.seekg(0);
    }
    TriangleMesh mesh = ply ? readPly(file, path) : readObj(file, path);
    for (const Eigen::Vector3d& v : mesh.vertices)
        if (!v.allFinite()) fail(path, "a vertex is not finite");
    if (mesh.vertices.empty())
        fail(path, "it has no vertices and no faces (is it a PLY or OBJ file?)");
    return mesh;
}
}  // namespace taut
