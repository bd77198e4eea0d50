#include "FolderSource.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "../MergedSource.h"
#include "../filesIn.h"
#include "CsvReader.h"
#include "readCloud.h"
#include "taut/core/TimeText.h"

namespace taut
{
namespace fs = std::filesystem;

namespace
{
constexpr const char* kImuFile = "imu.csv";

std::vector<fs::path> cloudsOf(const fs::path& folder)
{
    const fs::path scans = folder / "scans";
    auto files = filesIn(fs::is_directory(scans) ? scans : folder);
    const auto other = [](const fs::path& file)
    { return !isCloud(file) || file.filename() == kImuFile; };
    files.erase(std::remove_if(files.begin(), files.end(), other), files.end());
    const NameStamps stamps(files);
    if (std::all_of(files.begin(), files.end(), [&](const auto& f) { return !!stamps.of(f); }))
        std::stable_sort(
            files.begin(), files.end(),
            [&](const auto& a, const auto& b) { return stamps.of(a) < stamps.of(b); });
    return files;
}

/** The rows of imu.csv. */
class ImuTable
{
 public:
    ImuTable(const std::string& path, WarningSink warn) : csv_(path), warn_(std::move(warn))
    {
        const auto find = [this](const std::string& name)
        {
            const auto& all = csv_.columns();
            const auto it = std::find(all.begin(), all.end(), name);
            return it == all.end() ? -1 : static_cast<int>(it - all.begin());
        };
        t_ = find("t");
        t_ns_ = find("t_ns");
        if ((t_ < 0) == (t_ns_ < 0))
            throw std::runtime_error("'" + path + "' needs one column of times: t or t_ns");
        const std::array<std::string, 6> names{"gyro_x",  "gyro_y",  "gyro_z",
                                               "accel_x", "accel_y", "accel_z"};
        for (std::size_t i = 0; i < names.size(); i++)
        {
            values_[i] = find(names[i]);
            if (values_[i] < 0)
                throw std::runtime_error("'" + path + "' has no column " + names[i]);
        }
    }

    std::optional<ImuSample> next()
    {
        while (true)
        {
            try
            {
                if (!csv_.next(row_)) return {};
                return sample();
            }
            catch (const std::invalid_argument& e)
            {
                warn(csv_.where() + ": " + e.what());
            }
            catch (const std::runtime_error& e)
            {
                warn(e.what());
            }
        }
    }

 private:
    ImuSample sample() const
    {
        ImuSample sample;
        sample.t = parseSeconds(t_ >= 0 ? row_[t_] : row_[t_ns_] + "e-9");
        for (int i = 0; i < 3; i++)
        {
            sample.gyro[i] = parseNumber(row_[values_[i]]);
            sample.accel[i] = parseNumber(row_[values_[i + 3]]);
        }
        return sample;
    }

    void warn(const std::string& text) const
    {
        if (warn_) warn_({0, "imu_invalid", text + "; left out"});
    }

    CsvReader csv_;
    WarningSink warn_;
    int t_ = -1, t_ns_ = -1;
    std::array<int, 6> values_{};
    std::vector<std::string> row_;
};
/** First and last time of the IMU; nothing without one. */
std::optional<std::pair<Time, Time>> spanOfImu(const fs::path& file)
{
    if (!fs::exists(file)) return {};
    ImuTable table(file.string(), {});
    std::optional<std::pair<Time, Time>> span;
    while (const auto sample = table.next())
    {
        if (!span) span = {sample->t, sample->t};
        span->first = std::min(span->first, sample->t);
        span->second = std::max(span->second, sample->t);
    }
    return span;
}

/** The clouds and what the first of them tell. */
struct CloudFolder
{
    CloudFolder(const fs::path& folder, const ImportOptions& options, const WarningSink& warn)
        : files(cloudsOf(folder)), queue(files), reader(files, stampsOf(folder), options, warn)
    {
    }

    /** A pass through the IMU alone where its times can tell the unit of the names. */
    NameStamps stampsOf(const fs::path& folder) const
    {
        const NameStamps names(files);
        return names.finding().empty() ? names : NameStamps(files, spanOfImu(folder / kImuFile));
    }

    std::vector<fs::path> files;
    FileQueue queue;
    CloudReader reader;
};
}  // namespace

bool isPlainFolder(const Recording& recording)
{
    return recording.is_folder && !cloudsOf(recording.path).empty();
}

std::unique_ptr<ImportSource> openPlainFolder(
    const Recording& recording, const ImportOptions& options, const WarningSink& warn)
{
    SensorStreams streams;
    std::shared_ptr<CloudFolder> clouds;
    try
    {
        clouds = std::make_shared<CloudFolder>(recording.path, options, warn);
    }
    catch (const std::runtime_error& e)
    {
        throw std::runtime_error("'" + recording.path.string() + "': " + e.what());
    }
    streams.findings = {std::to_string(clouds->queue.size()) + " clouds"};
    streams.later_findings = [clouds] { return clouds->reader.findings(); };
    streams.progress = [clouds] { return clouds->queue.progress(); };
    streams.next_scan = [clouds, warn]
    {
        return clouds->queue.nextScan(
            [&](const fs::path& file) { return clouds->reader.read(file); }, warn);
    };
    const fs::path imu = recording.path / kImuFile;
    if (fs::exists(imu))
    {
        auto table = std::make_shared<ImuTable>(imu.string(), warn);
        streams.next_sample = [table] { return table->next(); };
        streams.tells_pose = options.pose_given;
        if (!options.pose_given) streams.findings.emplace_back(kPoseNotTold);
    }
    else
    {
        streams.next_sample = [] { return std::optional<ImuSample>(); };  // that it lacks is told
    }
    return std::make_unique<MergedSource>(recording.path.string(), std::move(streams), warn);
}
}  // namespace taut
