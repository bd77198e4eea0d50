#include "taut/core/NameExpression.h"

#include <algorithm>
#include <cctype>

#include "taut/core/Config.h"

namespace taut
{
namespace
{
/** Digits from here on. */
std::size_t digitsAt(const std::string& text, std::size_t at)
{
    const std::size_t begin = at;
    while (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0) at++;
    return at - begin;
}

/** The most digits of the number of a group, `\1`, or of repetitions, `{1,2}`. */
std::size_t mostDigits(const std::string& expression)
{
    std::size_t most = 0;
    for (std::size_t i = 0; i < expression.size(); i++)
    {
        if (expression[i] != '\\' && expression[i] != '{') continue;
        const std::size_t first = digitsAt(expression, i + 1), after = i + 1 + first;
        most = std::max(most, first);
        if (expression[i] == '\\')
            i++;  // what is escaped
        else if (after < expression.size() && expression[after] == ',')
            most = std::max(most, digitsAt(expression, after + 1));
    }
    return most;
}

std::regex compile(const std::string& what, const std::string& expression)
{
    const auto refuse = [&](const std::string& cause)
    {
        throw ConfigError(
            what + " '" + expression.substr(0, 100) + "' is not a regular expression: " + cause);
    };
    if (expression.size() > NameExpression::kLongest)
        refuse("it has more than " + std::to_string(NameExpression::kLongest) + " characters");
    if (mostDigits(expression) > NameExpression::kMostDigits)
        refuse(
            "the number of a group, and of repetitions, has at most " +
            std::to_string(NameExpression::kMostDigits) + " digits");
    try
    {
        return std::regex(expression, std::regex::ECMAScript);
    }
    catch (const std::regex_error& e)
    {
        refuse(e.what());
    }
    return {};
}
}  // namespace

NameExpression::NameExpression(const std::string& what, const std::string& expression)
    : all_(expression.empty()), regex_(compile(what, expression))
{
}

bool NameExpression::matches(const std::string& name) const
{
    return all_ || (name.size() <= kLongest && std::regex_match(name, regex_));
}
}  // namespace taut
