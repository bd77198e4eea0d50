#include "BagSource.h"

#include <algorithm>
#include <deque>
#include <stdexcept>

#include "BagFolder.h"
#include "BagKind.h"
#include "BagReader.h"
#include "Decompress.h"
#include "SweepClock.h"
#include "TopicChoice.h"

namespace taut
{
using namespace bag;
namespace fs = std::filesystem;

namespace
{
constexpr std::size_t kSweepsToJudge = 10;
constexpr Time kLatest = 4'600'000'000'000'000'000;  // ns: beyond what a stamp can be

const std::string kImuType = "sensor_msgs/Imu";
const std::string kCloudType = "sensor_msgs/PointCloud2";
const std::vector<std::string> kSweepTypes{
    kCloudType, "livox_ros_driver/CustomMsg", "livox_ros_driver2/CustomMsg"};

class BagSource : public ImportSource
{
 public:
    BagSource(std::string path, const ImportOptions& options, const WarningSink& warn)
        : path_(std::move(path)),
          warn_(warn),
          reader_(openBagReader(path_, warn)),
          clock_(options.scan_stamp, warn)
    {
        const auto topics = reader_->topics();
        const auto lidar = chooseTopic(topics, kSweepTypes, options.lidar_topic, "--lidar-topic");
        if (!lidar)
            throw std::runtime_error(
                path_ + " has no topic of a LiDAR (sensor_msgs/PointCloud2, Livox CustomMsg); " +
                "its topics: " + describe(topics));
        lidar_ = *lidar;
        std::vector<std::string> names{lidar_.name};
        imu_ = chooseTopic(topics, {kImuType}, options.imu_topic, "--imu-topic");
        if (imu_) names.push_back(imu_->name);
        reader_->choose(names);
        judged_.push_back("LiDAR: topic " + describe({lidar_}));
        if (imu_) judged_.push_back("IMU: topic " + describe({*imu_}));
    }

    std::optional<ImportedItem> next() override
    {
        if (!learned_) readAhead();
        while (true)
        {
            if (!ahead_.empty())
            {
                Pending pending = std::move(ahead_.front());
                ahead_.pop_front();
                if (auto item = finish(std::move(pending))) return item;
            }
            else if (auto pending = read())
                ahead_.push_back(std::move(*pending));
            else
                return checkedEnd();
        }
    }

    double progress() const override { return reader_->progress(); }

    std::vector<std::string> findings() const override
    {
        std::vector<std::string> all = judged_;
        all.insert(all.end(), clock_.findings().begin(), clock_.findings().end());
        return all;
    }

 private:
    /** Decoded, but not yet with a known clock. */
    using Pending = std::variant<ImuSample, RawSweep>;

    /** The first sweeps, enough to judge them. */
    void readAhead()
    {
        learned_ = true;
        std::vector<const RawSweep*> sweeps;
        while (sweeps.size() < kSweepsToJudge)
        {
            auto pending = read();
            if (!pending) break;
            ahead_.push_back(std::move(*pending));  // a deque leaves the others where they are
            if (const auto* sweep = std::get_if<RawSweep>(&ahead_.back())) sweeps.push_back(sweep);
        }
        if (sweeps.empty()) return;
        try
        {
            clock_.learn(sweeps);
        }
        catch (const std::runtime_error& e)
        {
            throw std::runtime_error(path_ + ", " + lidar_.name + ": " + e.what());
        }
    }

    /** The next message that is what it should be. */
    std::optional<Pending> read()
    {
        while (auto message = reader_->next())
        {
            message->received = std::clamp<Time>(message->received, 0, kLatest);
            try
            {
                return decode(*message);
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
        std::vector<std::uint8_t> plain;
        Bytes data = message.data;
        if (isZstd(data))  // rosbag2 can compress each message; no message begins like that
        {
            plain = decompress("zstd", data);
            data = {plain.data(), plain.size()};
        }
        const WireReader reader(data, message.wire);
        if (imu_ && message.topic == imu_->name) return readImu(reader);
        RawSweep sweep = lidar_.type == kCloudType ? toRawSweep(readPointCloud2(reader))
                                                   : toRawSweep(readLivox(reader));
        sweep.received = message.received;
        return sweep;
    }

    /** Nothing, and a warning, if it cannot be used. */
    std::optional<ImportedItem> finish(Pending pending)
    {
        if (auto* sample = std::get_if<ImuSample>(&pending))
        {
            if (!isLater(sample->t, last_reading_, "imu_time", imu_->name)) return {};
            if (!sample->gyro.allFinite() || !sample->accel.allFinite())
            {
                report(sample->t, "imu_invalid", imu_->name, "a value is not finite");
                return {};
            }
            return *sample;
        }
        auto& sweep = std::get<RawSweep>(pending);
        const Time header = sweep.header;
        try
        {
            if (header == 0)
                report(0, "no_stamp", lidar_.name, "a cloud has no stamp and is left out");
            else if (sweep.points.empty())
                report(header, "scan_empty", lidar_.name, "a cloud has no valid point");
            else
            {
                Scan scan = clock_.toScan(std::move(sweep));
                if (isLater(scan.stamp, last_scan_, "scan_time", lidar_.name)) return scan;
            }
        }
        catch (const std::runtime_error& e)
        {
            report(header, "message_invalid", lidar_.name, e.what());
        }
        return {};
    }

    /** Remembers the stamp if it is later than the one before. */
    bool isLater(Time t, std::optional<Time>& last, const char* kind, const std::string& topic)
    {
        if (t == 0)
            report(0, "no_stamp", topic, "a message has no stamp and is left out");
        else if (last && t <= *last)
            report(
                t, kind, topic,
                "a stamp is " + std::to_string(toSeconds(*last - t)) +
                    " s before the one before it; the message is left out");
        else
        {
            last = t;
            return true;
        }
        return false;
    }

    std::optional<ImportedItem> checkedEnd()
    {
        if (!last_scan_)
            throw std::runtime_error(path_ + ": no sweep of " + lidar_.name + " can be used");
        if (!last_reading_ && !ended_)
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
    std::unique_ptr<BagReader> reader_;
    BagTopic lidar_;
    std::optional<BagTopic> imu_;
    SweepClock clock_;
    std::vector<std::string> judged_;
    std::deque<Pending> ahead_;
    bool learned_ = false, ended_ = false;
    std::optional<Time> last_scan_, last_reading_;
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
    return std::make_unique<BagSource>(recording.path.string(), options, warn);
}
}  // namespace taut
