#include "PcapReplay.h"

#include <mrpt/core/initializer.h>
#include <mrpt/obs/CObservationComment.h>

#include <algorithm>
#include <stdexcept>

#include "EndOfReplay.h"
#include "taut/importing/openImportSource.h"

IMPLEMENTS_GENERIC_SENSOR(PcapReplay, taut)

// When the library is loaded, rawlog-grabber knows the driver by its name.
MRPT_INITIALIZER(register_PcapReplay)
{
    taut::PcapReplay::doRegister();
}

namespace taut
{
namespace
{
constexpr std::size_t kMostUnwritten = 128;        // bounds the memory: a scan may have 3 MB
constexpr Duration kLongestPause = 1'000'000'000;  // a gap in the recording is not waited out
constexpr auto kPatience = std::chrono::seconds(60);

Time timeOf(const ImportedItem& item)
{
    if (const auto* sample = std::get_if<ImuSample>(&item)) return sample->t;
    if (const auto* scan = std::get_if<Scan>(&item)) return scan->stamp;
    return std::get<PacketScan>(item).stamp;
}
}  // namespace

void PcapReplay::loadConfig_sensorSpecific(
    const mrpt::config::CConfigFileBase& config, const std::string& section)
{
    ImportingSensor::loadConfig_sensorSpecific(config, section);
    path_ = config.read_string(section, "pcap_input", "");
    options_.ouster_json = config.read_string(section, "ouster_json", "");
    options_.capture_clock = config.read_bool(section, "capture_clock", false);
    speed_ = config.read_double(section, "speed", speed_);
    if (path_.empty()) throw std::runtime_error("[" + section + "] has no pcap_input");
    if (!(speed_ >= 0))
        throw std::runtime_error("[" + section + "] has a speed that is not 0 or positive");
}

void PcapReplay::initialize()
{
    source_ = openImportSource(path_, options_, warnings());
    due_ = Clock::now();
    fetch();
    if (next_) now_ = timeOf(*next_);
    m_state = ssWorking;
}

void PcapReplay::doProcess()
{
    while (next_ && Clock::now() >= due_ && unwritten_.count() < kMostUnwritten) giveNext();
    if (!next_) waitForWriting();
}

void PcapReplay::fetch()
{
    next_ = source_->next();
    if (!next_) return end();
    const Time t = std::max(timeOf(*next_), now_);  // a scan comes after the samples in its sweep
    if (now_ != 0 && speed_ > 0)
        due_ += std::chrono::nanoseconds(static_cast<std::int64_t>(
            static_cast<double>(std::min(t - now_, kLongestPause)) / speed_));
    now_ = t;
}

void PcapReplay::giveNext()
{
    unwritten_.add(give(*next_));
    fetch();
}

/* rawlog-grabber writes half of what it has, rounded down, at each pass: the last observation would
 * never be written. A comment behind it is what is left unwritten instead. */
void PcapReplay::end()
{
    for (const auto& line : source_->findings()) logStr(mrpt::system::LVL_INFO, line);
    auto comment = mrpt::obs::CObservationComment::Create();
    comment->timestamp = mrpt::Clock::fromDouble(toSeconds(now_) + 1);
    comment->sensorLabel = getSensorLabel();
    comment->text = "end of " + path_;
    appendObservation(comment);
}

void PcapReplay::waitForWriting()
{
    const std::size_t left = unwritten_.count();
    if (left == 0)
        throw EndOfReplay(
            "end of '" + path_ + "': all of its " + std::to_string(scans()) + " scans and " +
                std::to_string(samples()) + " IMU samples are written" +
                (warned() == 0 ? ""
                               : ", but the warnings tell what of the capture could not be used"),
            warned() == 0);
    if (left != waiting_for_)
    {
        waiting_for_ = left;
        waiting_since_ = Clock::now();
    }
    if (Clock::now() - waiting_since_ > kPatience)
        throw std::runtime_error(
            "end of '" + path_ + "', but " + std::to_string(left) +
            " observations are not written: is use_sensoryframes set?");
}
}  // namespace taut
