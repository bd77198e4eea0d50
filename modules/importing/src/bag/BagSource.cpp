#include "BagSource.h"

#include <algorithm>
#include <deque>
#include <stdexcept>

#include "../intensityScale.h"
#include "BagFolder.h"
#include "BagKind.h"
#include "BagReader.h"
#include "Decompress.h"
#include "LidarPose.h"
#include "Messages.h"
#include "PacketSource.h"
#include "SensorOfTopic.h"
#include "SortedBag.h"
#include "SweepClock.h"
#include "TopicChoice.h"

namespace taut
{
using namespace bag;
namespace fs = std::filesystem;

namespace
{
constexpr std::size_t kSweepsToJudge = 10;
constexpr std::size_t kMostAhead = 20'000;           // messages; the LiDAR may have stopped early
constexpr Time kLatest = 4'600'000'000'000'000'000;  // ns: beyond what a stamp can be

const std::string kImuType = "sensor_msgs/Imu";
const std::string kCloudType = "sensor_msgs/PointCloud2";
const std::vector<std::string> kSweepTypes{
    kCloudType, "livox_ros_driver/CustomMsg", "livox_ros_driver2/CustomMsg",
    "livox_interfaces/CustomMsg"};

bool hasMessages(const std::vector<BagTopic>& topics)
{
    return std::any_of(topics.begin(), topics.end(), [](const auto& t) { return !t.empty; });
}

/** The LiDAR's topic: of clouds, or of packets where no clouds are meant. */
BagTopic chooseLidar(
    const std::string& path, const std::vector<BagTopic>& topics, const std::string& expression)
{
    const std::string option = "--lidar-topic";
    std::vector<BagTopic> packets;
    std::vector<std::string> types;
    for (const BagTopic& topic : topics)
    {
        if (!isPacketType(topic.type) || isOusterImu(topic)) continue;
        packets.push_back(topic);
        types.push_back(topic.type);
    }
    const auto clouds = matching(topics, kSweepTypes, expression, option);
    const auto of_packets = matching(packets, types, expression, option);
    const bool by_packets = !hasMessages(clouds) &&
                            (hasMessages(of_packets) || (clouds.empty() && !of_packets.empty()));
    const auto lidar = by_packets ? chooseTopic(packets, types, expression, option)
                                  : chooseTopic(topics, kSweepTypes, expression, option);
    if (!lidar)
        throw std::runtime_error(
            path + " has no topic of a LiDAR (sensor_msgs/PointCloud2, Livox CustomMsg, packets " +
            "of Velodyne, Hesai or Ouster); its topics: " + describe(topics));
    return *lidar;
}

class BagSource : public ImportSource
{
 public:
    BagSource(
        std::string path, std::unique_ptr<BagReader> reader, BagTopic lidar,
        std::optional<BagTopic> imu, LidarPose pose, const ImportOptions& options,
        const WarningSink& warn)
        : path_(std::move(path)),
          warn_(warn),
          lidar_(std::move(lidar)),
          imu_(std::move(imu)),
          bag_(
              path_, std::move(reader), lidar_, imu_, fromSeconds(options.lidar_clock_offset),
              warn),
          sensor_(options.lidar_id),
          time_field_(options.time_field),
          pose_(std::move(pose)),
          clock_(options.scan_stamp, warn)
    {
        judged_.push_back("LiDAR: topic " + describe({lidar_}));
        if (imu_) judged_.push_back("IMU: topic " + describe({*imu_}));
        if (!pose_.finding.empty()) judged_.push_back(pose_.finding);
    }

    std::optional<ImportedItem> next() override
    {
        while (true)
        {
            if ((learned_ || sweeps_read_ == 0) && !ahead_.empty())
            {
                Pending pending = std::move(ahead_.front());
                ahead_.pop_front();
                if (auto item = finish(std::move(pending))) return item;
                continue;
            }
            auto pending = read();
            if (!pending && learned_) return checkedEnd();
            const bool at_end = !pending;
            if (pending) take(std::move(*pending));
            if (!learned_ &&
                (at_end || sweeps_read_ == kSweepsToJudge || ahead_.size() == kMostAhead))
                learn();
        }
    }

    std::optional<Duration> arrivalDelay() const override { return clock_.arrivalDelay(); }
    double progress() const override { return bag_.progress(); }

    std::vector<std::string> findings() const override
    {
        std::vector<std::string> all = judged_;
        all.insert(all.end(), bag_.findings().begin(), bag_.findings().end());
        for (std::string& line : clock_.findings()) all.push_back(std::move(line));
        if (intensity_scale_ != 1) all.emplace_back(kIntensityScaled);
        return all;
    }

    bool tellsPose() const override { return pose_.finding.empty() || pose_.T_imu_lidar; }

 private:
    /** Decoded, but not yet with a known clock. */
    using Pending = std::variant<ImuSample, RawSweep>;

    void take(Pending pending)
    {
        if (std::holds_alternative<RawSweep>(pending)) sweeps_read_++;
        ahead_.push_back(std::move(pending));
    }

    /** Judges the clock by the sweeps that were read ahead. */
    void learn()
    {
        std::vector<const RawSweep*> sweeps;
        for (const Pending& pending : ahead_)
            if (const auto* sweep = std::get_if<RawSweep>(&pending)) sweeps.push_back(sweep);
        learned_ = true;
        if (sweeps.empty()) return;
        try
        {
            sensor_.learn(sweeps);
            const auto other = [this](const RawSweep* sweep) { return !sensor_.isOf(*sweep); };
            sweeps.erase(std::remove_if(sweeps.begin(), sweeps.end(), other), sweeps.end());
            clock_.learn(sweeps);
            IntensityRange range;
            for (const RawSweep* sweep : sweeps)
                for (const LidarPoint& point : sweep->points) range.add(point.intensity);
            intensity_scale_ = static_cast<float>(range.scale());
        }
        catch (const std::runtime_error& e)
        {
            throw std::runtime_error(path_ + ", " + lidar_.name + ": " + e.what());
        }
    }

    /** The next message that is what it should be. */
    std::optional<Pending> read()
    {
        while (auto message = bag_.next())
        {
            message->received = std::clamp<Time>(message->received, 0, kLatest);
            try
            {
                return decode(*message);
            }
            catch (const FieldError& e)
            {
                throw std::runtime_error(path_ + ", " + message->topic + ": " + e.what());
            }
            catch (const std::runtime_error& e)
            {
                report(message->received, "message_invalid", message->topic, e.what());
            }
        }
        return {};
    }

    Pending decode(const BagMessage& message) const
    {
        std::vector<std::uint8_t> buffer;
        const WireReader reader(plainMessage(message.data, buffer), message.wire);
        if (imu_ && message.topic == imu_->name) return readImu(reader);
        RawSweep sweep = lidar_.type == kCloudType
                             ? toRawSweep(readPointCloud2(reader), time_field_)
                             : toRawSweep(readLivox(reader));
        sweep.received = message.received;
        return sweep;
    }

    /** Nothing, and a warning, if it cannot be used. */
    std::optional<ImportedItem> finish(Pending pending)
    {
        if (auto* sample = std::get_if<ImuSample>(&pending))
        {
            if (!hasStamp(sample->t, imu_->name)) return {};
            readings_++;
            return *sample;
        }
        auto& sweep = std::get<RawSweep>(pending);
        if (!sensor_.takes(sweep)) return {};
        const Time header = sweep.header;
        if (!clock_.knowsTimesWithoutStamps() && !hasStamp(header, lidar_.name)) return {};
        if (sweep.points.empty())
        {
            report(header, "scan_empty", lidar_.name, "a cloud has no valid point");
            return {};
        }
        try
        {
            if (intensity_scale_ != 1)
                for (LidarPoint& point : sweep.points) point.intensity *= intensity_scale_;
            Scan scan = clock_.toScan(std::move(sweep));
            if (pose_.T_imu_lidar) scan.T_imu_lidar = *pose_.T_imu_lidar;
            scans_++;
            return scan;
        }
        catch (const std::runtime_error& e)
        {
            report(header, "message_invalid", lidar_.name, e.what());
            return {};
        }
    }

    bool hasStamp(Time t, const std::string& topic) const
    {
        if (t == 0) report(0, "no_stamp", topic, "a message has no stamp and is left out");
        return t != 0;
    }

    std::optional<ImportedItem> checkedEnd()
    {
        if (!ended_ && sensor_.others() > 0)
            report(
                0, "second_sensor", lidar_.name,
                std::to_string(sensor_.others()) + " sweeps of another sensor, " +
                    sensor_.nameOfOthers() + ", are left out");
        if (scans_ == 0)
            throw std::runtime_error(path_ + ": no sweep of " + lidar_.name + " can be used");
        if (readings_ == 0 && !ended_)
            report(
                0, "no_imu", path_,
                imu_ ? "no reading of the IMU on " + imu_->name
                     : "no topic of an IMU (sensor_msgs/Imu)");
        ended_ = true;
        return {};
    }

    void report(Time t, const char* kind, const std::string& where, const std::string& what) const
    {
        if (warn_) warn_({t, kind, where + ": " + what});
    }

    std::string path_;
    WarningSink warn_;
    BagTopic lidar_;
    std::optional<BagTopic> imu_;
    SortedBag bag_;
    SensorOfTopic sensor_;
    std::string time_field_;
    LidarPose pose_;
    SweepClock clock_;
    std::vector<std::string> judged_;
    std::deque<Pending> ahead_;
    float intensity_scale_ = 1;
    bool learned_ = false, ended_ = false;
    std::size_t sweeps_read_ = 0, scans_ = 0, readings_ = 0;
};
}  // namespace

bool isBag(const Recording& recording)
{
    if (!recording.is_folder) return kindOf(recording.head) != BagKind::None;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(recording.path, error))
        if (hasBagName(entry.path())) return true;
    return false;
}

std::unique_ptr<ImportSource> openBag(
    const Recording& recording, const ImportOptions& options, const WarningSink& warn)
{
    const std::string path = recording.path.string();
    auto reader = openBagReader(path, warn);
    const auto topics = topicsOf(*reader);
    const BagTopic lidar = chooseLidar(path, topics, options.lidar_topic);
    if (isPacketType(lidar.type))
        return openPackets(path, std::move(reader), topics, lidar, options, warn);
    const auto imu = chooseTopic(topics, {kImuType}, options.imu_topic, "--imu-topic");
    LidarPose pose;
    if (imu && !options.pose_given) pose = bag::findLidarPose(path, topics, lidar, *imu, warn);
    return std::make_unique<BagSource>(
        path, std::move(reader), lidar, imu, std::move(pose), options, warn);
}
}  // namespace taut
