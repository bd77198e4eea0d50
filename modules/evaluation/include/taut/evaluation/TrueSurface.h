#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "taut/core/Geometry.h"
#include "taut/files/MeshFile.h"

namespace taut
{
/** The true surface of a place: triangles, or a dense cloud of points. Distances are exact, by a
 * tree of boxes in double precision. Threads may share one. */
class TrueSurface
{
 public:
    /** A mesh without triangles is a cloud. Throws std::runtime_error if there is nothing in it,
     * std::invalid_argument for more than 2^31 triangles or points. */
    explicit TrueSurface(TriangleMesh mesh);

    bool isCloud() const { return mesh_.triangles.empty(); }
    std::size_t size() const { return isCloud() ? mesh_.vertices.size() : mesh_.triangles.size(); }

    /** [m^2]; 0 of a cloud. */
    double area() const { return area_; }

    struct Nearest
    {
        static constexpr std::uint32_t kNone = 0xffffffff;
        std::uint32_t element = kNone;  //!< triangle or point; kNone: none within the bound
        Vector3d point = Vector3d::Zero();
        double distance = std::numeric_limits<double>::infinity();  //!< [m]
    };

    /** The nearest point of the surface, if it is nearer than `bound`. `guess`: an element that may
     * be near, such as that of a query beside; it makes the search faster. */
    Nearest nearest(
        const Vector3d& p, double bound = std::numeric_limits<double>::infinity(),
        std::uint32_t guess = Nearest::kNone) const;

    /** Unit normal of an element: of a triangle, or of the plane through the points of a cloud
     * around one. Zero where there is none. The sign has no meaning. */
    Vector3d normalOf(std::uint32_t element) const;

    /** About so many points spread evenly over the area. Of a cloud: its points, one in each cell
     * of `cell` [m], and of these every k-th. */
    std::vector<Vector3d> samples(std::size_t count, double cell) const;

    /** Of a cloud: median distance of a point to the nearest other one [m], of up to 2000 points.
     */
    double spacing() const { return spacing_; }

 private:
    struct Node
    {
        Vector3d min, max;
        std::uint32_t begin = 0;  //!< of a leaf: first element; else: first child
        std::uint32_t count = 0;  //!< elements of a leaf; 0: inner node, two children in sequence
    };

    Vector3d corner(std::uint32_t element, int i) const
    {
        return mesh_.vertices[isCloud() ? element : mesh_.triangles[element][i]];
    }
    Vector3d nearestOn(std::uint32_t element, const Vector3d& p) const;
    template <class Skip>
    void search(const Vector3d& p, Nearest& best, const Skip& skip) const;
    void build();
    void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);
    void collect(const Vector3d& p, double radius, std::vector<Vector3d>& points) const;

    TriangleMesh mesh_;
    std::vector<Vector3d> centres_;        //!< of the elements, while the tree is built
    std::vector<std::uint32_t> elements_;  //!< in the order of the leaves
    std::vector<Node> nodes_;
    double area_ = 0, spacing_ = 0;
};
}  // namespace taut
