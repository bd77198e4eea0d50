#pragma once

#include <map>
#include <optional>
#include <string>

#include "taut/core/NameExpression.h"

namespace taut
{
/** Picks the one sensor of a kind by its label: by a regular expression, or as the only one there.
 */
class SensorChoice
{
 public:
    /** `kind` and `option` are for messages: "LiDAR", "--lidar". Throws std::runtime_error if
     * the expression is none. */
    SensorChoice(std::string kind, std::string option, const std::string& expression);

    /** True if this label is the chosen one. Throws std::runtime_error, naming all labels of that
     * kind seen so far, if a second one asks to be. */
    bool accepts(const std::string& label);

    const std::optional<std::string>& chosen() const { return chosen_; }
    bool byExpression() const { return expression_.has_value(); }
    std::string describeSeen() const;

 private:
    std::string kind_, option_;
    std::optional<NameExpression> expression_;
    std::optional<std::string> chosen_;
    std::map<std::string, bool> matches_;  // of every label seen
};
}  // namespace taut
