#pragma once

#include <set>
#include <string>
#include <vector>

#include "RawSweep.h"
#include "taut/core/NameExpression.h"

namespace taut::bag
{
/** Tells the sweeps of one sensor from those of others on the same topic, by RawSweep::sensor. */
class SensorOfTopic
{
 public:
    /** `expression`: regular expression for the whole name, or empty. */
    explicit SensorOfTopic(std::string expression)
        : name_("--lidar-id", expression), expression_(std::move(expression))
    {
    }

    /** Chooses what matches the expression; else the only one that more than one of these sweeps
     * are of. Throws std::runtime_error, naming them, if it is none or several. */
    void learn(const std::vector<const RawSweep*>& sweeps);

    bool isOf(const RawSweep& sweep) const;

    /** The same; counts what is of others. */
    bool takes(const RawSweep& sweep);

    std::size_t others() const { return others_; }
    std::string nameOfOthers() const;  //!< "'a', 'b'"

 private:
    NameExpression name_;
    std::string expression_, sensor_;
    std::size_t others_ = 0;
    std::set<std::string> names_of_others_;
};
}  // namespace taut::bag
