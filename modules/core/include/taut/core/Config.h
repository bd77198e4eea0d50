#pragma once

#include <mrpt/containers/yaml.h>

#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace taut
{
/** A configuration that cannot be used; what() names the key. */
struct ConfigError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

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
    /** `node` is a map or null (all defaults); `path` names the section in messages. */
    explicit ConfigSection(mrpt::containers::yaml node = {}, std::string path = "");

    void key(const std::string& name, double& value, Range range, const std::string& doc);
    void key(const std::string& name, int& value, Range range, const std::string& doc);
    void key(const std::string& name, bool& value, const std::string& doc);
    void key(const std::string& name, std::string& value, const std::string& doc);

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

    bool has(const std::string& name) const;
    std::string pathOf(const std::string& name) const;
    void record(const std::string& name, const std::string& value, const std::string& doc);
    void print(std::string& out, int indent) const;
    [[noreturn]] void throwUnknownChoice(
        const std::string& name, const std::string& text,
        const std::vector<std::string>& known) const;

    mrpt::containers::yaml node_;
    std::string path_;
    std::vector<Entry> entries_;
};
}  // namespace taut
