#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/Yaml.h"

namespace taut
{
/** Smallest and largest value allowed, both included. */
struct Range
{
    double min, max;
};
inline constexpr Range kAnyNumber{-1e300, 1e300};
inline constexpr Range kNotNegative{0, 1e300};
inline constexpr Range kPositive{1e-300, 1e300};

/** One section of the configuration. A struct with defaults declares its keys once; the same
 * declaration reads the values given, checks their range and records the value that took effect:
 *
 *     section.key("voxel_size", config.voxel_size, kPositive, "m, edge of a voxel");
 *
 * After all keys are declared, rejectUnknown() throws on a key that nobody asked for. */
class ConfigSection
{
 public:
    /** `node` is a map or null (all defaults); `path` names the section in messages, `file` where
     * it stands. */
    explicit ConfigSection(YamlNode node = {}, std::string path = "", std::string file = "");

    void key(const std::string& name, double& value, Range range, const std::string& doc);
    void key(const std::string& name, int& value, Range range, const std::string& doc);
    void key(const std::string& name, bool& value, const std::string& doc);
    void key(const std::string& name, std::string& value, const std::string& doc);
    /** A list of numbers, each within the range. */
    void key(
        const std::string& name, std::vector<double>& value, Range range, const std::string& doc);

    /** An enumeration, by name. */
    template <class Enum>
    void choice(
        const std::string& name, Enum& value, const std::map<std::string, Enum>& names,
        const std::string& doc)
    {
        std::string text;
        for (const auto& [n, v] : names)
            if (v == value) text = n;
        key(name, text, doc);
        const auto it = names.find(text);
        if (it == names.end())
        {
            std::vector<std::string> known;
            known.reserve(names.size());
            for (const auto& entry : names) known.push_back(entry.first);
            throwUnknownChoice(name, text, known);
        }
        value = it->second;
    }

    /** A nested section; created empty where it is not given. The reference stays valid. */
    ConfigSection& section(const std::string& name);

    /** Lays a value of a section over what the file gives, before that section is asked for. */
    void lay(const std::string& section, const std::string& name, double value);
    void lay(const std::string& section, const std::string& name, bool value);

    /** Throws ConfigError naming the first key, here or below, that was given but never declared.
     */
    void rejectUnknown() const;

    /** YAML text of everything declared: values as they took effect, docs as comments. */
    std::string effective() const;

    const std::string& path() const { return path_; }

 private:
    struct Entry
    {
        std::string name, value, doc;
        std::unique_ptr<ConfigSection> child;  // null for a plain key
    };

    std::optional<std::string> textOf(const std::string& name) const;
    std::string pathOf(const std::string& name) const;
    std::string keyAt(const std::string& name) const;
    std::string lineOf(int line) const;
    void checkRange(const std::string& name, double value, const Range& range) const;
    void record(const std::string& name, const std::string& value, const std::string& doc);
    void print(std::string& out, int indent) const;
    [[noreturn]] void throwUnknownChoice(
        const std::string& name, const std::string& text,
        const std::vector<std::string>& known) const;

    YamlNode node_;
    std::string path_, file_;
    std::vector<Entry> entries_;
};
}  // namespace taut
