#include "taut/map/OccupancyMap.h"

#include <fstream>
#include <sstream>

#include "taut/core/writeError.h"

namespace taut
{
namespace
{
constexpr int kInsertionsPerPruning = 32;

octomap::point3d toOctomap(const Vector3d& p)
{
    return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

template <class Write>
void writeFile(const std::string& path, const Write& write)
{
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    if (!file || !write(file) || !file.flush()) throw writeError(path);
}

/** What stands before the data of OctoMap's files: its own writers of it print on the terminal. */
std::ostream& writeHeader(std::ostream& file, const char* kind, const octomap::OcTree& tree)
{
    return file << kind << "\nid " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
                << tree.getResolution() << "\ndata\n";
}

std::uint64_t voxelOf(const octomap::OcTreeKey& key)
{
    return packVoxel(key[0], key[1], key[2]);
}

/** Key of the cell twice as large that holds the cell of this key; the tree's origin stays. */
octomap::OcTreeKey coarserKey(const octomap::OcTreeKey& key)
{
    constexpr int origin = 1 << 15;
    octomap::OcTreeKey coarser;
    for (unsigned i = 0; i < 3; i++)
        coarser[i] = static_cast<octomap::key_type>(((key[i] - origin) >> 1) + origin);
    return coarser;
}
}  // namespace

void OccupancyMap::Config::declare(ConfigSection& section)
{
    section.key("resolution", resolution, {1e-3, 1e3}, "m, edge of a cell");
    section.key("max_range", max_range, kPositive, "m, of a ray");
    section.key("max_nodes", max_nodes, {1000, 1e9}, "more: the resolution is halved");
}

OccupancyMap::OccupancyMap(const Config& config)
    : config_(config), tree_(std::make_unique<octomap::OcTree>(config.resolution))
{
}

void OccupancyMap::insert(
    Time t, const Vector3d& origin, const std::vector<Vector3d>& points, const WarningSink& warn)
{
    if (!origin.allFinite())
        throw std::invalid_argument("OccupancyMap: the position of the sensor is not finite");
    octomap::OcTreeKey key;
    const auto fits = [&](const Vector3d& p)
    { return tree_->coordToKeyChecked(toOctomap(p), key); };
    octomap::Pointcloud cloud;
    std::size_t finite = 0;
    for (const Vector3d& point : points)
    {
        if (!point.allFinite()) continue;
        finite++;
        if (fits(origin) && fits(point)) cloud.push_back(toOctomap(point));
    }
    if (warn && cloud.size() < finite)
        warn(
            {t, "occupancy_range",
             std::to_string(finite - cloud.size()) + " points left out: too far from the origin"});

    insertRays(toOctomap(origin), cloud);
    inserted_++;
    const auto most = static_cast<std::size_t>(config_.max_nodes);
    if (inserted_ % kInsertionsPerPruning == 0 || tree_->size() > most) updateInnerNodes();
    while (tree_->size() > most)
    {
        const std::size_t before = tree_->size();
        halveResolution();
        std::ostringstream text;
        text << "more than " << config_.max_nodes << " nodes: cells are now " << resolution()
             << " m";
        if (warn) warn({t, "occupancy_coarser", text.str()});
        if (tree_->size() >= before) break;  // a handful of cells far apart
    }
}

void OccupancyMap::insertRays(const octomap::point3d& origin, const octomap::Pointcloud& ends)
{
    octomap::OcTreeKey key;
    VoxelSet end_cells;
    std::vector<octomap::OcTreeKey> rays;
    for (const octomap::point3d& end : ends)
        if (tree_->coordToKeyChecked(end, key) && end_cells.insert(voxelOf(key)))
            rays.push_back(key);

    VoxelSet hit, passed;
    std::vector<octomap::OcTreeKey> occupied, free;
    octomap::KeyRay ray;
    const auto max_range = static_cast<float>(config_.max_range);
    for (const octomap::OcTreeKey& cell : rays)
    {
        octomap::point3d end = tree_->keyToCoord(cell);
        const octomap::point3d way = end - origin;
        const bool in_range = way.norm() <= config_.max_range;
        if (in_range && hit.insert(voxelOf(cell))) occupied.push_back(cell);
        if (!in_range) end = origin + way.normalized() * max_range;
        if (!tree_->computeRayKeys(origin, end, ray)) continue;
        for (const octomap::OcTreeKey& on_way : ray)
            if (!surely_free_.contains(voxelOf(on_way)) && passed.insert(voxelOf(on_way)))
                free.push_back(on_way);
    }
    for (const octomap::OcTreeKey& cell : free)
    {
        if (hit.contains(voxelOf(cell))) continue;
        const octomap::OcTreeNode* node = tree_->updateNode(cell, false, /*lazy_eval=*/true);
        if (node->getLogOdds() <= tree_->getClampingThresMinLog())
            surely_free_.insert(voxelOf(cell));
    }
    for (const octomap::OcTreeKey& cell : occupied)
    {
        tree_->updateNode(cell, true, /*lazy_eval=*/true);
        surely_free_.erase(voxelOf(cell));
    }
}

void OccupancyMap::updateInnerNodes() const
{
    tree_->updateInnerOccupancy();
    tree_->prune();
}

const octomap::OcTree& OccupancyMap::tree() const
{
    updateInnerNodes();
    return *tree_;
}

void OccupancyMap::halveResolution()
{
    auto coarser = std::make_unique<octomap::OcTree>(2 * tree_->getResolution());
    for (auto leaf = tree_->begin_leafs(), end = tree_->end_leafs(); leaf != end; ++leaf)
    {
        // A leaf of 2^n cells a side has 2^(n-1) coarser ones; a single cell shares its own.
        const unsigned cells = 1u << (tree_->getTreeDepth() - leaf.getDepth());
        const unsigned coarse_cells = cells > 1 ? cells / 2 : 1;
        const octomap::OcTreeKey first = coarserKey(leaf.getIndexKey());
        for (unsigned i = 0; i < coarse_cells * coarse_cells * coarse_cells; i++)
        {
            const octomap::OcTreeKey key(
                static_cast<octomap::key_type>(first[0] + i % coarse_cells),
                static_cast<octomap::key_type>(first[1] + i / coarse_cells % coarse_cells),
                static_cast<octomap::key_type>(first[2] + i / coarse_cells / coarse_cells));
            const octomap::OcTreeNode* known = coarser->search(key);
            if (!known || known->getLogOdds() < leaf->getLogOdds())
                coarser->setNodeValue(key, leaf->getLogOdds(), /*lazy_eval=*/true);
        }
    }
    coarser->updateInnerOccupancy();
    coarser->prune();
    tree_ = std::move(coarser);
    surely_free_.clear();
}

void OccupancyMap::writeOt(const std::string& path) const
{
    const octomap::OcTree& t = tree();
    writeFile(
        path,
        [&](std::ostream& file) -> std::ostream&
        { return t.writeData(writeHeader(file, "# Octomap OcTree file", t)); });
}

void OccupancyMap::writeBt(const std::string& path) const
{
    const octomap::OcTree& t = tree();
    writeFile(
        path,
        [&](std::ostream& file) -> std::ostream&
        { return t.writeBinaryData(writeHeader(file, "# Octomap OcTree binary file", t)); });
}
}  // namespace taut
