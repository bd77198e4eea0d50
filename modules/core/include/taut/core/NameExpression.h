#pragma once

#include <regex>
#include <string>

namespace taut
{
/** A regular expression (ECMAScript) for the whole name of a sensor or a topic.
 *
 * The library of C++ goes down the stack for each character of what it reads, and adds up the
 * digits of a number without end. Expressions and names from files are therefore bounded. */
class NameExpression
{
 public:
    static constexpr std::size_t kLongest = 1000;  //!< [bytes] of an expression, and of a name
    static constexpr std::size_t kMostDigits = 4;  //!< of a number in an expression

    /** `what` stands for the expression in messages: "--lidar-topic". Throws ConfigError quoting
     * the expression if it is none, or too long. */
    NameExpression(const std::string& what, const std::string& expression);

    /** An expression that is empty matches every name. No other one matches a name that is too
     * long. */
    bool matches(const std::string& name) const;

 private:
    bool all_;
    std::regex regex_;
};
}  // namespace taut
