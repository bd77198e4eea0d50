#include "taut/core/Config.h"

#include <cmath>
#include <sstream>

namespace taut
{
namespace
{
std::string numberText(double v)
{
    std::ostringstream s;
    s.precision(12);
    s << v;
    return s.str();
}

void checkRange(const std::string& path, double value, const Range& range)
{
    if (std::isfinite(value) && value >= range.min && value <= range.max) return;
    std::ostringstream s;
    s << "configuration key '" << path << "' is " << value << ", outside of ";
    if (range.min == kPositive.min && range.max == kPositive.max)
        s << "the positive numbers";
    else if (range.max == kAnyNumber.max)
        s << "the numbers from " << range.min << " up";
    else
        s << "[" << range.min << ", " << range.max << "]";
    throw ConfigError(s.str());
}
}  // namespace

ConfigSection::ConfigSection(mrpt::containers::yaml node, std::string path)
    : node_(std::move(node)), path_(std::move(path))
{
    if (!node_.isNullNode() && !node_.isMap())
        throw ConfigError(
            path_.empty() ? "the configuration is not a map of keys and values"
                          : "configuration section '" + path_ + "' is not a map of keys");
}

std::string ConfigSection::pathOf(const std::string& name) const
{
    return path_.empty() ? name : path_ + "." + name;
}

bool ConfigSection::has(const std::string& name) const
{
    return node_.isMap() && node_.has(name);
}

void ConfigSection::record(
    const std::string& name, const std::string& value, const std::string& doc)
{
    Entry e;
    e.name = name;
    e.value = value;
    e.doc = doc;
    entries_.push_back(std::move(e));
}

void ConfigSection::key(const std::string& name, double& value, Range range, const std::string& doc)
{
    if (has(name))
    {
        const auto text = node_[name].as<std::string>();
        std::istringstream s(text);
        s.imbue(std::locale::classic());
        double v = 0;
        if (!(s >> v) || !(s >> std::ws).eof())
            throw ConfigError(
                "configuration key '" + pathOf(name) + "' is not a number: '" + text + "'");
        value = v;
    }
    checkRange(pathOf(name), value, range);
    record(name, numberText(value), doc);
}

void ConfigSection::key(const std::string& name, int& value, Range range, const std::string& doc)
{
    if (has(name))
    {
        const auto text = node_[name].as<std::string>();
        std::istringstream s(text);
        int v = 0;
        if (!(s >> v) || !(s >> std::ws).eof())
            throw ConfigError(
                "configuration key '" + pathOf(name) + "' is not a whole number: '" + text + "'");
        value = v;
    }
    checkRange(pathOf(name), value, range);
    record(name, std::to_string(value), doc);
}

void ConfigSection::key(const std::string& name, bool& value, const std::string& doc)
{
    if (has(name))
    {
        const auto text = node_[name].as<std::string>();
        if (text != "true" && text != "false")
            throw ConfigError(
                "configuration key '" + pathOf(name) + "' is neither true nor false: '" + text +
                "'");
        value = text == "true";
    }
    record(name, value ? "true" : "false", doc);
}

void ConfigSection::key(const std::string& name, std::string& value, const std::string& doc)
{
    if (has(name)) value = node_[name].as<std::string>();
    std::string quoted = "'";
    for (const char c : value) quoted += c == '\'' ? std::string("''") : std::string(1, c);
    record(name, quoted + "'", doc);
}

ConfigSection& ConfigSection::section(const std::string& name)
{
    for (auto& e : entries_)
        if (e.child && e.name == name) return *e.child;
    Entry e;
    e.name = name;
    mrpt::containers::yaml child;
    if (has(name)) child = node_[name];
    e.child = std::make_unique<ConfigSection>(child, pathOf(name));
    entries_.push_back(std::move(e));
    return *entries_.back().child;
}

void ConfigSection::rejectUnknown() const
{
    if (node_.isMap())
        for (const auto& [k, v] : node_.asMap())
        {
            const auto name = k.as<std::string>();
            bool known = false;
            for (const auto& e : entries_) known = known || e.name == name;
            if (known) continue;
            std::string message = "unknown configuration key '" + pathOf(name) + "'; known here:";
            for (const auto& e : entries_) message += " " + e.name;
            throw ConfigError(message);
        }
    for (const auto& e : entries_)
        if (e.child) e.child->rejectUnknown();
}

void ConfigSection::print(std::string& out, int indent) const
{
    const std::string pad(static_cast<std::size_t>(indent), ' ');
    for (const auto& e : entries_)
    {
        if (e.child)
        {
            out += pad + e.name + ":\n";
            e.child->print(out, indent + 2);
        }
        else
        {
            out += pad + e.name + ": " + e.value + "  # " + e.doc + "\n";
        }
    }
}

std::string ConfigSection::effective() const
{
    std::string out;
    print(out, 0);
    return out;
}

void ConfigSection::throwUnknownChoice(
    const std::string& name, const std::string& text, const std::vector<std::string>& known) const
{
    std::string message =
        "configuration key '" + pathOf(name) + "' is '" + text + "'; choose from:";
    for (const auto& k : known) message += " " + k;
    throw ConfigError(message);
}
}  // namespace taut
