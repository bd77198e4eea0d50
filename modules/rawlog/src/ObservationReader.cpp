#include "ObservationReader.h"

#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <stdexcept>

#include "ErrorText.h"

namespace taut
{
ObservationReader::ObservationReader(const std::string& path) : input_(path)
{
    while (queue_.empty() && readObject())
    {
    }
    if (objects_ == 0)
        throw std::runtime_error(
            "'" + path + "' is not a rawlog: " + (damage_.empty() ? "it holds nothing" : damage_));
}

mrpt::obs::CObservation::Ptr ObservationReader::next()
{
    while (queue_.empty())
        if (!readObject()) return {};
    auto observation = std::move(queue_.front());
    queue_.pop_front();
    return observation;
}

/* Objects are dispatched by class, which serves both formats (observations; pairs of actions and
 * sensory frames) and mixtures of them. An object that fails ends the reading: objects carry no
 * length, so that there is no way to find the next one. */
bool ObservationReader::readObject()
{
    if (finished_) return false;
    finished_ = true;
    try
    {
        if (input_.atEnd()) return false;
        auto archive = mrpt::serialization::archiveFrom(input_);
        const auto object = archive.ReadObject();
        if (!object) throw std::runtime_error("an empty object");
        objects_++;
        if (auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
            queue_.push_back(std::move(observation));
        else if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
            for (const auto& one : *frame) queue_.push_back(one);
        finished_ = false;
    }
    catch (const std::exception& e)
    {
        damage_ = errorText(e);
    }
    return !finished_;
}
}  // namespace taut
