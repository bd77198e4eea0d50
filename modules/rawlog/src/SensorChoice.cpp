#include "SensorChoice.h"

#include <stdexcept>

#include "taut/core/ChoiceNeeded.h"

namespace taut
{
SensorChoice::SensorChoice(std::string kind, std::string option, const std::string& expression)
    : kind_(std::move(kind)), option_(std::move(option))
{
    if (!expression.empty()) expression_.emplace("the sensor label", expression);
}

bool SensorChoice::accepts(const std::string& label)
{
    const auto [it, is_new] = matches_.try_emplace(label, true);
    if (is_new) it->second = !expression_ || expression_->matches(label);
    if (!it->second) return false;
    if (!chosen_) chosen_ = label;
    if (*chosen_ == label) return true;
    throw ChoiceNeeded(
        "more than one " + kind_ + (expression_ ? " matches the label given" : " is in the log") +
            ": " + describeSeen(),
        option_, expressionFor(*chosen_));
}

std::string SensorChoice::describeSeen() const
{
    std::string text;
    for (const auto& entry : matches_)
        text += std::string(text.empty() ? "" : ", ").append("'" + entry.first + "'");
    return text;
}
}  // namespace taut
