#pragma once

#include <tsl/robin_set.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "taut/core/Map.h"
#include "taut/core/VoxelSet.h"
#include "taut/map/KeyTable.h"
#include "taut/map/StatisticsTree.h"

namespace taut
{
struct OctreeMapConfig
{
    double leaf_size = 0.125;  //!< [m] edge of the smallest node; the smallest window is twice that
    int scales = 5;            //!< number of window sizes, each twice the one before
    int min_points = 8;        //!< fewest points of a window that is believed
    double scale_tolerance =
        1.3;  //!< a larger window may be thicker than the thinnest by this factor
    double max_thickness = 0.15;  //!< [m] thicker windows are no planes
    double max_flatness = 0.2;    //!< largest ratio of thickness to the smaller extent in the plane
    double min_width = 0.05;      //!< [m] deviation across a window that a normal needs
    double min_cosine = 0.05;     //!< of the angle between the normal and the views of its points
    double min_spread = 0.2;      //!< the same as a share of the half edge of the window
    double gate = 0.8;            //!< [m] largest distance from a surface to be matched with it
    double min_sigma = 0.005;     //!< [m] no surface is believed to be thinner
    double dense_points = 200;    //!< in a node of 4 leaf_size, which then takes one point in four
    bool lines = false;           //!< match thin, long windows as lines
    double window_radius = 100;   //!< [m] half edge of the cube around the body that is kept
};

/** Local map in an octree whose nodes hold the statistics of their points at every scale. A query
 * is matched with the plane (or line) of the largest window around it that is as flat as the
 * smallest one: the scale at which the world is planar there. A plane no thicker than the noise
 * along the rays makes it ends the search: what is thinner is so by chance. A window is the cube of
 * 2 x 2 x 2 nodes around the node corner nearest to the query, so that no query lies near a
 * window's edge, where a surface would be seen cut in two. A surface seen from one side is not
 * matched with queries seen from the other: both sides of a floor or a wall are surfaces of their
 * own.
 *
 * A window is made of the tree when a query asks for it, in the scratch of the caller, and so is
 * one that the map keeps but that is due to be compared with the tree. The map takes them over in
 * keep(): its callers decide which windows are kept, and since when. What is kept may lag by a
 * fifth of its points. The noise along the rays is learnt from the points that are inserted. */
class OctreeMap : public Map
{
    DEFINE_MRPT_OBJECT(OctreeMap, taut)
 public:
    OctreeMap();
    OctreeMap(const OctreeMap& other);
    OctreeMap& operator=(const OctreeMap&) = delete;
    void configure(ConfigSection& section) override;
    void match(
        const std::vector<MapPoint>& queries, std::vector<Correspondence>& correspondences,
        MapScratch& scratch, Executor& executor) const override;
    void insert(const std::vector<MapPoint>& points, Executor& executor) override;
    void keep(MapScratch& scratch) override;
    void slide(const Vector3d& center_world) override;
    bool empty() const override { return !tree_ || tree_->size() == 0; }
    std::size_t size() const override { return tree_ ? tree_->size() : 0; }
    void clear() override;

    OctreeMapConfig config;

 private:
    /** What the points of a window look like. In the order of need: a search reads the first 64
     * bytes, a correspondence the next, and only the comparison with the tree the rest. */
    struct alignas(64) Window
    {
        Vector3d normal = Vector3d::UnitZ();
        double cosine = 0;            //!< of the normal to the mean direction to the sensor
        double variance = 0;          //!< along the normal, not below min_sigma^2 [m^2]
        double largest_variance = 0;  //!< that it may have for all that its points say
        double count = 0;             //!< points when it was computed; 0: not known yet
        std::uint32_t checked = 0;    //!< insertion after which it was last compared with the tree
        std::uint8_t patience = 0;    //!< insertions to wait before it is compared again
        bool plane = false, line = false;  //!< it looks like one

        Vector3d mean = Vector3d::Zero(), axis = Vector3d::UnitX();
        double width2 = 0, length2 = 0;  //!< variances along the other two axes [m^2]

        std::uint32_t age = 0;  //!< insertions between the last two comparisons; 0: there was one
        std::array<std::uint16_t, 3> corner{};
        double seen = 0;                              //!< points at the last comparison
        std::array<StatisticsTree::Place, 8> places;  //!< of its nodes

        /** Has what the comparison with the tree needs at hand when it is needed soon. */
        void prefetchCheck() const
        {
            __builtin_prefetch(&age);
            for (std::size_t i = 0; i < places.size(); i += 4) __builtin_prefetch(&places[i]);
        }
        /** Takes what another one knows of the comparison, without what its points look like. */
        void takeCheck(const Window& other)
        {
            count = other.count;
            checked = other.checked;
            patience = other.patience;
            age = other.age;
            corner = other.corner;
            seen = other.seen;
            places = other.places;
        }
    };
    /** Windows by number. They stay where they are: moving them to a larger array would touch as
     * much memory as all of them fill. */
    class Windows
    {
     public:
        Windows() = default;
        Windows(const Windows& other);  //!< without places, which are nodes of the other's tree
        Windows(Windows&&) = default;
        Windows& operator=(const Windows&) = delete;
        Windows& operator=(Windows&&) = default;
        Window& operator[](std::uint32_t i) { return blocks_[i / kBlock][i % kBlock]; }
        const Window& operator[](std::uint32_t i) const { return blocks_[i / kBlock][i % kBlock]; }
        std::uint32_t add();  //!< one that has to be filled
        void remove(std::uint32_t i) { free_.push_back(i); }
        void clear();  //!< keeps the memory

     private:
        static constexpr std::uint32_t kBlock = 256;
        std::vector<std::unique_ptr<Window[]>> blocks_;
        std::uint32_t size_ = 0;
        std::vector<std::uint32_t> free_;
    };
    struct Level
    {
        KeyTable index;  //!< of the windows, by corner
        Windows windows;

        std::uint32_t at(std::uint64_t corner);  //!< the number of a window, made if it is new
        void put(const Window& window);          //!< in place of the one that is there, if any
    };

    /** The cube of half a leaf that holds a point, from the corner of all that keys name; {} where
     * keys do not reach. It tells the nearest corners of nodes of every size. */
    using Cell = std::array<std::uint32_t, 3>;

    static constexpr std::uint32_t kNoWindow = KeyTable::kNone;
    static constexpr std::int8_t kNoLevel = 127;

    /** The search of one query: from the largest window down. */
    struct Search
    {
        std::uint32_t best = kNoWindow, window = kNoWindow;
        std::int8_t best_level = -1;
        std::int8_t last_level = kNoLevel;  //!< the last one it looked at
        bool active = true, line = false;
        Cell cell{};                          //!< of the query
        FeatureKind kind = FeatureKind::Any;  //!< of the query
        Vector3d view = Vector3d::Zero();     //!< of the query
        double view_reach = 1e300;  //!< by which that may change before a window changes sides
    };
    /** Where a query looked at a level: iterations seldom leave a window. */
    struct Lookup
    {
        std::uint64_t corner = 0;
        std::uint32_t window = kNoWindow;  //!< of the map, or with kAsked one of the scratch
        std::uint32_t epoch = 0;           //!< of the scratch when it looked there
    };
    static constexpr std::uint32_t kAsked = 0x80000000;

    /** Windows that the map does not keep, or not as they look now. */
    struct Asked : Level
    {
        std::vector<std::uint32_t> kept;   //!< their numbers in the map; kNoWindow: new ones
        std::vector<std::uint32_t> shown;  //!< in their place: those of the map that look the same

        void clear();  //!< keeps the memory
    };

    /** The last match() of a caller: good for the next one until the map changes. */
    struct Scratch
    {
        std::shared_ptr<const char> state;  //!< of the map; held, so that no other one is like it
        std::uint32_t epoch = 0;            //!< what is of an earlier one counts no more
        std::vector<Search> searches;
        std::vector<std::uint32_t> active;  //!< those that go on
        std::vector<Lookup> lookups;        //!< a query and level each
        std::vector<Asked> asked;           //!< by level

        Lookup& lookup(std::size_t query, int level)
        {
            return lookups[query * asked.size() + static_cast<std::size_t>(level)];
        }
    };

    template <class Outside>
    void forgetWindows(const Outside& outside);
    void moveWindows(const std::array<int, 3>& shift);
    void keep(Scratch& scratch);
    void changed() { state_ = std::make_shared<const char>(); }
    void recenter(const Vector3d& center_world);
    Cell cellOf(const Vector3d& p) const;
    static std::uint64_t cornerOf(const Cell& cell, int level);
    static std::uint64_t cornerOf(const Window& window);
    void remember(const octomap::OcTreeKey& leaf);
    void rememberBlocks(const StatisticsTree::Entries& sorted);
    bool isStale(const Window& window) const;
    void refreshAll(
        Windows& windows, const std::vector<std::uint32_t>& stale, int level,
        Executor& executor) const;
    void locate(Window& window, int level) const;
    void refresh(Window& window, int level) const;
    void schedule(Window& window, double count) const;
    void compute(Window& window, int level, const PointStatistics& statistics) const;
    void prepare(Scratch& scratch, std::size_t queries) const;
    void search(const std::vector<MapPoint>& queries, Scratch& scratch, Executor& executor) const;
    void findWindows(Scratch& scratch, int level) const;
    void askForWindows(Scratch& scratch, int level, Executor& executor) const;
    bool isDue(const Windows& kept, std::uint32_t number) const;
    void makeAsked(Asked& asked, std::uint32_t first, int level, Executor& executor) const;
    const Window& windowOf(const Scratch& scratch, int level, std::uint32_t number) const;
    Search searchOf(const MapPoint& query) const;
    bool isSettled(const MapPoint& query, Scratch& scratch, std::size_t i) const;
    void advance(Search& search, const Scratch& scratch, const MapPoint& query, int level) const;
    Correspondence planeAt(const Vector3d& query, const Window& window) const;
    Correspondence lineAt(const Vector3d& query, const Window& window) const;
    static bool isOnSideOf(const Window& window, Search& search);
    bool isThinAsNoise(const Window& window) const;
    void learnRangeNoise(const std::vector<MapPoint>& points, Executor& executor);
    bool isPlane(const Window& window, int level, double thickness2) const;
    bool isLine(const Window& window) const;
    unsigned blockDepth() const;
    bool leafOf(const Vector3d& p, octomap::OcTreeKey& leaf) const;
    StatisticsTree::Entry entryOf(const Vector3d& p, std::uint32_t index) const;
    std::uint32_t weightOf(const octomap::OcTreeKey& leaf, std::uint32_t point) const;

    std::unique_ptr<StatisticsTree> tree_;
    std::vector<Level> levels_;  // of windows that are kept
    double range_noise_ = 0;     //!< [m] as the planes of the last points show it
    std::uint32_t insertions_ = 0;
    std::shared_ptr<const char> state_;  // another one after every change
    // Of the last insertion; kept, since fresh memory is slow.
    StatisticsTree::Entries entries_;
    Scratch learning_;
    VoxelSet dense_;  //!< nodes that hold enough to take a share of what comes, for all of it
    tsl::robin_set<std::uint64_t, VoxelHash> blocks_;  // coarse nodes that exist, for slide()
    Vector3d last_center_ = Vector3d::Constant(1e300);
    /** Where the keys begin [m]: octomap names 2^16 leaves a side, which moves with the body. */
    Vector3d origin_ = Vector3d::Zero();
};
}  // namespace taut
