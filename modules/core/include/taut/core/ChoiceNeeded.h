#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace taut
{
/** A recording has several sensors of a kind, and nobody said which one is meant. */
class ChoiceNeeded : public std::runtime_error
{
 public:
    /** `text` lists them; `option` chooses the one named, `value` (a regular expression). */
    ChoiceNeeded(const std::string& text, std::string option, std::string value)
        : std::runtime_error(text + "; choose one with " + option + " " + value),
          text_(text),
          option_(std::move(option)),
          value_(std::move(value))
    {
    }

    const std::string& text() const { return text_; }
    const std::string& option() const { return option_; }
    const std::string& value() const { return value_; }

 private:
    std::string text_, option_, value_;
};

/** A regular expression (ECMAScript) that matches this text and no other. */
inline std::string expressionFor(const std::string& text)
{
    std::string expression;
    for (const char c : text)
    {
        if (std::string("^$\\.*+?()[]{}|").find(c) != std::string::npos) expression += '\\';
        expression += c;
    }
    return expression;
}
}  // namespace taut
