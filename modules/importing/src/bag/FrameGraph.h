#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "taut/core/Geometry.h"

namespace taut::bag
{
/** Frames and the transforms between them that a recording tells (tf). Whether a transform is told
 * from parent to child or the other way does not matter here, nor how many parents a frame has:
 * only ways that contradict each other do. */
class FrameGraph
{
 public:
    /** One more word on a pair of frames. One that differs from an earlier word on them makes the
     * pair a moving one. Names may begin with a slash, as in old bags. Memory is bounded: the
     * words on more than 2,000 pairs are not taken. False if it tells nothing new. */
    bool add(const std::string& parent, const std::string& child, const Pose& T_parent_child);

    /** The pose of one frame in another, or why there is none. */
    struct Answer
    {
        std::optional<Pose> T_to_from;
        std::string way;    //!< the frames on it: "imu <- base <- lidar"
        std::string cause;  //!< why there is no pose; empty if there is one
    };
    Answer find(const std::string& to, const std::string& from) const;

    bool empty() const { return edges_.empty(); }

    /** The name without a slash at its begin. */
    static std::string plainName(const std::string& frame);

 private:
    using Pair = std::pair<std::string, std::string>;
    struct Edge
    {
        Pose T_first_second;  // of the pair
        bool moves = false;
    };
    /** A frame that was reached, and over which. */
    struct Reached
    {
        std::string over;
        Pose T_to_frame;
    };
    using Tree = std::map<std::string, Reached>;

    Tree reach(const std::string& to, bool over_moving) const;
    static std::vector<std::string> wayTo(const Tree& tree, std::string frame);
    std::optional<std::string> contradiction(
        const Tree& tree, const std::vector<std::string>& way) const;
    std::string whyApart(const std::string& to, const std::string& from) const;

    std::map<Pair, Edge> edges_;
    std::map<std::string, std::set<std::string>> neighbours_;
};
}  // namespace taut::bag
