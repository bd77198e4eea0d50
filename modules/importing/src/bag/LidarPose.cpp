#include "LidarPose.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "../ImportFormat.h"
#include "Decompress.h"
#include "FrameGraph.h"
#include "Messages.h"
#include "taut/core/format.h"

namespace taut::bag
{
namespace
{
constexpr Duration kStaticsComeWithin = 2'000'000'000;  // of the bag's begin, by the recorder
constexpr std::size_t kMostNamed = 100;                 // transforms that are warned of

bool isTransforms(const BagTopic& topic)
{
    return topic.type == "tf2_msgs/TFMessage" || topic.type == "tf/tfMessage";
}

bool isStatic(const std::string& topic)
{
    const std::string end = "tf_static";
    return topic.size() >= end.size() &&
           topic.compare(topic.size() - end.size(), end.size(), end) == 0;
}

/** Why it is no transform; empty if it is one. */
std::string faultOf(const FrameTransform& t)
{
    const std::string parent = FrameGraph::plainName(t.parent),
                      child = FrameGraph::plainName(t.child);
    if (parent.empty() || child.empty()) return "a frame has no name";
    if (parent == child) return "it joins a frame with itself";
    if (!t.translation.allFinite() || !t.rotation.coeffs().allFinite())
        return "its values are not finite";
    const double norm = t.rotation.norm();
    if (std::abs(norm - 1) > 0.01) return format("its quaternion has a norm of %.3g", norm);
    return "";
}

std::string described(const Pose& T)
{
    const double degree = M_PI / 180;
    const double yaw = std::atan2(T.R(1, 0), T.R(0, 0)),
                 pitch = std::asin(std::clamp(-T.R(2, 0), -1.0, 1.0)),
                 roll = std::atan2(T.R(2, 1), T.R(2, 2));
    return format(
        "x %.4g, y %.4g, z %.4g m, yaw %.4g, pitch %.4g, roll %.4g deg", T.p.x(), T.p.y(), T.p.z(),
        yaw / degree, pitch / degree, roll / degree);
}

/** Reads as much of a bag as it takes to know the pose. */
class Search
{
 public:
    Search(
        const std::string& path, const std::vector<BagTopic>& topics, const BagTopic& lidar,
        const BagTopic& imu, const WarningSink& warn)
        : warn_(warn), lidar_(lidar), imu_(imu), reader_(openBagReader(path, {}))
    {
        std::vector<std::string> names{lidar.name, imu.name};
        for (const BagTopic& topic : topics)
            if (isTransforms(topic) && !topic.empty) names.push_back(topic.name);
        any_transforms_ = names.size() > 2;
        reader_->choose(names);
    }

    LidarPose run()
    {
        read();
        if (lidar_frame_ && lidar_frame_ == imu_frame_ && !lidar_frame_->empty())
            return {
                Pose{},
                "T_imu_lidar: none, LiDAR and IMU name the same frame '" + *imu_frame_ + "'"};
        if (!any_transforms_) return {{}, kPoseNotTold};
        std::string cause;
        if (!isNamed(lidar_frame_) || !isNamed(imu_frame_))
        {
            cause = "the messages on " + (isNamed(imu_frame_) ? lidar_.name : imu_.name) +
                    " name no frame";
        }
        else
        {
            for (const bool with_moving : {false, true})
            {
                const auto answer =
                    (with_moving ? all_ : statics_).find(*imu_frame_, *lidar_frame_);
                cause = answer.cause;
                if (!answer.T_to_from) continue;
                return {
                    answer.T_to_from, "T_imu_lidar: " + described(*answer.T_to_from) + " (" +
                                          (with_moving ? "tf: " : "tf_static: ") + answer.way +
                                          ")"};
            }
        }
        if (warn_)
            warn_(
                {0, "pose_unknown",
                 "tf does not tell where the LiDAR is on the IMU: " + cause +
                     "; it is taken to be where the IMU is, with its axes: give its pose in a rig "
                     "file"});
        return {{}, kPoseNotTold};
    }

 private:
    static bool isNamed(const std::optional<std::string>& frame)
    {
        return frame && !frame->empty();
    }

    void read()
    {
        std::optional<Time> begin;
        while (const auto message = reader_->next())
        {
            if (!begin) begin = message->received;
            try
            {
                take(*message);
            }
            catch (const std::runtime_error&)  // whoever reads the sensors tells it
            {
            }
            if (!isTold()) continue;
            if (!any_transforms_ || message->received - *begin > kStaticsComeWithin) return;
        }
    }

    /** Whether reading on cannot tell more, but for contradictions. */
    bool isTold()
    {
        if (!lidar_frame_ || !imu_frame_) return false;
        if (!any_transforms_ || lidar_frame_ == imu_frame_) return true;
        if (lidar_frame_->empty() || imu_frame_->empty()) return true;
        if (std::exchange(statics_changed_, false))
            joined_ = statics_.find(*imu_frame_, *lidar_frame_).T_to_from.has_value();
        return joined_;
    }

    void take(const BagMessage& message)
    {
        std::vector<std::uint8_t> buffer;
        const bool of_lidar = message.topic == lidar_.name, of_imu = message.topic == imu_.name;
        if ((of_lidar && lidar_frame_) || (of_imu && imu_frame_)) return;
        const WireReader reader(plainMessage(message.data, buffer), message.wire);
        if (of_lidar)
            lidar_frame_ = frameOf(lidar_, reader);
        else if (of_imu)
            imu_frame_ = frameOf(imu_, reader);
        else
            for (const FrameTransform& t : readTransforms(reader)) add(t, isStatic(message.topic));
    }

    std::string frameOf(const BagTopic& topic, const WireReader& reader)
    {
        statics_changed_ = true;
        if (isOusterPacketType(topic.type)) return "";  // bytes alone
        return FrameGraph::plainName(readFrame(reader));
    }

    void add(const FrameTransform& t, bool is_static)
    {
        const std::string fault = faultOf(t);
        if (!fault.empty())
        {
            if (named_.size() < kMostNamed && named_.emplace(t.parent, t.child).second && warn_)
                warn_(
                    {0, "tf_invalid",
                     "the transform of '" + t.parent + "' to '" + t.child +
                         "' is left out: " + fault});
            return;
        }
        const Pose T_parent_child{t.rotation.normalized().toRotationMatrix(), t.translation};
        all_.add(t.parent, t.child, T_parent_child);
        if (is_static && statics_.add(t.parent, t.child, T_parent_child)) statics_changed_ = true;
    }

    WarningSink warn_;
    BagTopic lidar_, imu_;
    std::unique_ptr<BagReader> reader_;
    bool any_transforms_ = false, statics_changed_ = false, joined_ = false;
    std::optional<std::string> lidar_frame_, imu_frame_;
    FrameGraph statics_, all_;
    std::set<std::pair<std::string, std::string>> named_;
};
}  // namespace

LidarPose findLidarPose(
    const std::string& path, const std::vector<BagTopic>& topics, const BagTopic& lidar,
    const BagTopic& imu, const WarningSink& warn)
{
    return Search(path, topics, lidar, imu, warn).run();
}
}  // namespace taut::bag
