#include "ObservationReader.h"

#include <mrpt/rtti/CObject.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/archiveFrom_std_vector.h>

#include <stdexcept>
#include <utility>

#include "ErrorText.h"
#include "ObjectCopy.h"
#include "PassOver.h"
#include "Utf8.h"

namespace taut
{
using mrpt::obs::CObservation;

namespace
{
constexpr int kOldestFrame = 1, kNewestFrame = 2;  // in version 0 the frame has the stamp

CObservation::Ptr deserialize(const ObjectCopy& copy)
{
    auto archive = mrpt::serialization::archiveFrom(copy.bytes());
    auto observation = std::dynamic_pointer_cast<CObservation>(archive.ReadObject());
    if (!observation) throw std::runtime_error("an object is not what its name says");
    observation->sensorLabel = validUtf8(observation->sensorLabel);
    return observation;
}
}  // namespace

ObservationReader::ObservationReader(const std::string& path, WaitForGrowth wait)
    : input_(path, std::move(wait))
{
    first_ = read();
    if (objects_ == 0)
        throw std::runtime_error(
            "'" + path + "' is not a rawlog: " + (damage_.empty() ? "it holds nothing" : damage_));
}

std::optional<LogEntry> ObservationReader::next()
{
    return first_ ? std::exchange(first_, {}) : read();
}

/* An object that fails ends the reading: objects carry no length, so that the next one cannot be
 * told from what its values happen to be. */
std::optional<LogEntry> ObservationReader::read()
{
    while (!finished_)
    {
        try
        {
            if (auto entry = readObject()) return entry;
        }
        catch (const std::exception& e)
        {
            // Of a log that is left while it is written, the last object may not be whole yet.
            if (!input_.isLeft()) damage_ = errorText(e);
            finished_ = true;
        }
    }
    return {};
}

/* Objects are dispatched by class, which serves both formats (observations; pairs of actions and
 * sensory frames) and mixtures of them. */
std::optional<LogEntry> ObservationReader::readObject()
{
    if (frame_ == 0u)
    {
        endFrame();
        return {};
    }
    if (!frame_ && input_.atEnd())
    {
        finished_ = true;
        return {};
    }
    const auto next = input_.peek(kLongestHeader);
    const auto header = parseObjectHeader(next.data, next.size);
    if (!header)
        throw std::runtime_error(
            next.size < kLongestHeader ? "the file ends in the middle of an object"
                                       : "there is no object where one must begin");
    if (!mrpt::rtti::findRegisteredClass(header->name))
        throw std::runtime_error("an object is of the unknown class '" + header->name + "'");
    const std::string name = header->shortName();
    if (name == "CSensoryFrame")
    {
        beginFrame(*header);
        return {};
    }
    if (frame_) --*frame_;
    LogEntry entry = readObservation(*header);
    objects_++;
    const bool is_observation = name.rfind("CObservation", 0) == 0;
    return is_observation ? std::optional(std::move(entry)) : std::nullopt;
}

void ObservationReader::beginFrame(const ObjectHeader& header)
{
    if (frame_) throw std::runtime_error("a sensory frame lies within another");
    if (header.version < kOldestFrame || header.version > kNewestFrame)
        throw std::runtime_error(
            "version " + std::to_string(header.version) + " of the class '" + header.name +
            "' is not known");
    input_.skip(header.bytes);
    if (header.version < kNewestFrame) input_.skip(sizeof(std::uint32_t));  // its number
    std::uint32_t count = 0;
    input_.read(&count, sizeof count);
    frame_ = count;
    objects_++;
}

void ObservationReader::endFrame()
{
    std::uint8_t mark = 0;
    input_.read(&mark, sizeof mark);
    if (mark != kObjectEnd) throw std::runtime_error("the end mark of a sensory frame is missing");
    frame_.reset();
}

LogEntry ObservationReader::readObservation(const ObjectHeader& header)
{
    LogEntry entry;
    entry.class_name = header.shortName();
    if (ObjectCopy::knows(entry.class_name))
    {
        const ObjectCopy copy(input_, header);
        entry.observation = deserialize(copy);
        entry.label = entry.observation->sensorLabel;
        entry.bytes = copy.bytes().size();
    }
    else
    {
        entry.label = validUtf8(passOver(input_, header, frame_ == 0u));
    }
    return entry;
}
}  // namespace taut
