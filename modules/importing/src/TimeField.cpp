#include "TimeField.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <stdexcept>

namespace taut
{
namespace
{
std::string lower(std::string text)
{
    std::transform(
        text.begin(), text.end(), text.begin(),
        [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/** In small letters, without what CloudCompare puts before a name. */
std::string plainName(const std::string& name)
{
    const std::string plain = lower(name), prefix = "scalar_";
    return plain.compare(0, prefix.size(), prefix) == 0 ? plain.substr(prefix.size()) : plain;
}

/** "time_offset_ns" as time, offset, ns. */
std::vector<std::string> wordsOf(const std::string& name)
{
    std::vector<std::string> words(1);
    for (const char c : plainName(name))
        if (std::isalnum(static_cast<unsigned char>(c)))
            words.back() += c;
        else if (!words.back().empty())
            words.emplace_back();
    return words;
}

bool looksLikeTime(const std::string& name)
{
    static const std::set<std::string> known{"ts",    "dt",   "tow",   "sec",  "secs", "nsec",
                                             "nsecs", "usec", "usecs", "msec", "tns",  "toffset"};
    const std::string plain = plainName(name);
    if (plain.find("time") != std::string::npos || plain.find("stamp") != std::string::npos)
        return true;
    const auto words = wordsOf(name);
    const auto is_known = [](const std::string& word) { return known.count(word) > 0; };
    return std::any_of(words.begin(), words.end(), is_known) ||
           (words.front() == "t" &&
            (words.size() == 1 || unitOfName(name) > 0 || words.back() == "offset"));
}

std::string listed(const std::vector<std::string>& names, const std::vector<std::size_t>& which)
{
    std::string text;
    for (const std::size_t i : which) text += (text.empty() ? "'" : ", '") + names[i] + "'";
    return text;
}
}  // namespace

double unitOfName(const std::string& name)
{
    static const std::map<std::string, double> units{
        {"ns", 1},          {"nsec", 1},     {"nsecs", 1},
        {"nanoseconds", 1}, {"us", 1e3},     {"usec", 1e3},
        {"usecs", 1e3},     {"micros", 1e3}, {"microseconds", 1e3},
        {"ms", 1e6},        {"msec", 1e6},   {"milliseconds", 1e6},
        {"s", 1e9},         {"sec", 1e9},    {"secs", 1e9},
        {"seconds", 1e9}};
    const auto words = wordsOf(name);
    const auto unit = units.find(words.back());
    return words.size() > 1 && unit != units.end() ? unit->second : 0;
}

int timeFieldOf(const std::vector<std::string>& names, const std::string& asked)
{
    static const std::vector<std::string> known{
        "t",           "time",       "timestamp", "offset_time", "time_stamp",
        "time_offset", "timeoffset", "stamps",    "stamp",       "ts"};
    if (asked == kNoTimeField) return -1;
    std::vector<std::size_t> all, alike;
    for (std::size_t i = 0; i < names.size(); i++)
    {
        if (!asked.empty() && names[i] == asked) return static_cast<int>(i);
        all.push_back(i);
        if (looksLikeTime(names[i])) alike.push_back(i);
    }
    if (!asked.empty())
        throw std::runtime_error(
            "--time-field '" + asked + "' is no field of the points; there are " +
            listed(names, all));
    for (const bool exactly : {true, false})
        for (const std::string& name : known)
            for (const std::size_t i : alike)
                if ((exactly ? names[i] : plainName(names[i])) == name) return static_cast<int>(i);
    if (alike.size() > 1)
        throw std::runtime_error(
            "several fields may hold the times of the points: " + listed(names, alike) +
            "; --time-field chooses, 'none' says that there are no times");
    return alike.empty() ? -1 : static_cast<int>(alike.front());
}
}  // namespace taut
