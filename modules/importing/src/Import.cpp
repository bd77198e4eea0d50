#include "taut/importing/Import.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "SensorSummary.h"
#include "taut/core/NameExpression.h"
#include "taut/importing/openImportSource.h"

namespace taut
{
namespace
{
/** Warnings about what is used all the same, as RawlogSource has them. */
constexpr const char* kUsedAllTheSame[] = {"no_imu",          "imu_order",    "imu_units",
                                           "scan_bad_points", "clock_offset", "scan_times",
                                           "rig_unused"};

/** Without the parts that describe another sensor than the one that is imported. */
Rig rigOf(const ImportConfig& config, const WarningSink& warn)
{
    Rig rig = config.rig;
    const auto keep = [&](auto& part, const std::string& label)
    {
        if (NameExpression("the sensor label", part.label).matches(label)) return;
        if (warn)
            warn(
                {0, "rig_unused",
                 "the rig file describes '" + part.label + "', but the label written is '" + label +
                     "'"});
        part = {};
    };
    keep(rig.lidar, config.lidar_label);
    keep(rig.imu, config.imu_label);
    return rig;
}

ImportOptions optionsOf(const ImportConfig& config, const Rig& rig)
{
    ImportOptions options = config.options;
    if (rig.imu.accel_scale != 1) options.accel_scale = rig.imu.accel_scale;
    if (rig.lidar.clock_offset != 0) options.lidar_clock_offset = rig.lidar.clock_offset;
    options.pose_given = rig.lidar.T_vehicle_lidar.has_value();
    if (rig.imu.gyro_scale != 1) options.gyro_scale = rig.imu.gyro_scale;
    return options;
}
}  // namespace

struct Import::Impl
{
    Impl(const ImportConfig& c, const WarningSink& w)
        : config(c),
          warn([this, w](const Warning& warning) { take(warning, w); }),
          rig(rigOf(c, warn)),
          source(openImportSource(c.path, optionsOf(c, rig), warn))
    {
        if (rig.lidar.T_vehicle_lidar)
            T_imu_lidar =
                rig.imu.T_vehicle_imu.value_or(Pose{}).inverse() * *rig.lidar.T_vehicle_lidar;
    }

    void take(const Warning& warning, const WarningSink& next)
    {
        const bool used = std::any_of(
            std::begin(kUsedAllTheSame), std::end(kUsedAllTheSame),
            [&](const char* kind) { return warning.kind == kind; });
        left_out += used ? 0 : 1;
        if (next) next(warning);
    }

    void apply(ImuSample& sample) { samples.add(sample.t); }

    template <class AnyScan>
    void apply(AnyScan& scan)
    {
        const Duration clock_offset = fromSeconds(rig.lidar.clock_offset);
        scan.stamp += clock_offset;
        if constexpr (std::is_same_v<AnyScan, Scan>) scan.end += clock_offset;
        if (T_imu_lidar) scan.T_imu_lidar = *T_imu_lidar;
        scans.add(scan.stamp);
    }

    ImportConfig config;
    WarningSink warn;
    std::size_t left_out = 0;
    Rig rig;
    std::optional<Pose> T_imu_lidar;  // of the rig
    std::unique_ptr<ImportSource> source;
    SensorSummary scans, samples;
};

Import::Import(const ImportConfig& config, const WarningSink& warn)
    : impl_(std::make_unique<Impl>(config, warn))
{
}
Import::~Import() = default;

std::optional<RecordedItem> Import::next()
{
    auto item = impl_->source->next();
    if (item) std::visit([this](auto& i) { impl_->apply(i); }, *item);
    return item;
}

double Import::progress() const
{
    return impl_->source->progress();
}

std::vector<std::string> Import::findings() const
{
    std::vector<std::string> lines{
        "LiDAR '" + impl_->config.lidar_label + "': " + impl_->scans.text(),
        "IMU '" + impl_->config.imu_label + "': " + impl_->samples.text()};
    for (std::string& finding : impl_->source->findings()) lines.push_back(std::move(finding));
    if (impl_->T_imu_lidar) lines.emplace_back("T_imu_lidar: of the rig file");
    return lines;
}

bool Import::tellsPose() const
{
    return impl_->T_imu_lidar || impl_->source->tellsPose();
}

std::size_t Import::leftOut() const
{
    return impl_->left_out;
}

Pose Import::T_vehicle_imu() const
{
    return impl_->rig.imu.T_vehicle_imu.value_or(Pose{});
}

std::size_t Import::scans() const
{
    return impl_->scans.count();
}

Duration Import::span() const
{
    return impl_->scans.span();
}

void readByImport(RawlogConfig& config, const ImportOptions& options)
{
    ImportConfig import;
    import.path = config.path;
    import.options = options;
    import.rig = config.rig;
    config.rig = rigOf(import, {});  // the warnings come with the reading
    // RawlogSource adds it; the import has to know it, to compare the clocks.
    import.options.lidar_clock_offset = config.rig.lidar.clock_offset;
    import.rig.lidar.clock_offset = 0;
    config.rig.lidar.label.clear();
    config.rig.lidar.T_vehicle_lidar.reset();
    config.rig.imu.label.clear();
    config.rig.imu.T_vehicle_imu.reset();
    config.rig.imu.accel_scale = config.rig.imu.gyro_scale = 1;
    config.open = [import](const WarningSink& warn) -> std::unique_ptr<ItemSource>
    { return std::make_unique<Import>(import, warn); };
}
}  // namespace taut
