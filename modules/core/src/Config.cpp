#include "taut/core/Config.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "taut/core/quotedYaml.h"

namespace taut
{
namespace
{
/** The shortest text that reads back to the same bits. */
std::string numberText(double v)
{
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, v, std::chars_format::general);
    return {buffer, end.ptr};
}

template <class Number>
std::optional<Number> numberIn(const std::string& text)
{
    std::istringstream s(text);
    s.imbue(std::locale::classic());
    Number v{};
    if (!(s >> v) || !(s >> std::ws).eof()) return std::nullopt;
    return v;
}
}  // namespace

ConfigSection::ConfigSection(YamlNode node, std::string path, std::string file)
    : node_(std::move(node)), path_(std::move(path)), file_(std::move(file))
{
    if (node_.isNull() || node_.isMap()) return;
    throw ConfigError(
        lineOf(node_.line) + (path_.empty()
                                  ? "the configuration is not a map of keys and values"
                                  : "configuration section '" + path_ + "' is not a map of keys"));
}

std::string ConfigSection::lineOf(int line) const
{
    if (line == 0) return "";
    return (file_.empty() ? "line " : file_ + ":") + std::to_string(line) + ": ";
}

std::string ConfigSection::pathOf(const std::string& name) const
{
    return path_.empty() ? name : path_ + "." + name;
}

std::string ConfigSection::keyAt(const std::string& name) const
{
    const YamlNode* value = node_.find(name);
    return lineOf(value != nullptr ? value->line : 0) + "configuration key '" + pathOf(name) + "'";
}

std::optional<std::string> ConfigSection::textOf(const std::string& name) const
{
    const YamlNode* value = node_.find(name);
    if (value == nullptr) return std::nullopt;
    if (value->isNull()) throw ConfigError(keyAt(name) + " has no value");
    if (value->kind != YamlNode::Kind::Scalar)
        throw ConfigError(
            keyAt(name) + " is a " + (value->isMap() ? "section" : "list") +
            "; a single value was expected");
    return value->scalar;
}

void ConfigSection::checkRange(const std::string& name, double value, const Range& range) const
{
    if (std::isfinite(value) && value >= range.min && value <= range.max) return;
    std::ostringstream s;
    s << keyAt(name) << " is " << value << ", outside of ";
    if (range.min == kPositive.min && range.max == kPositive.max)
        s << "the positive numbers";
    else if (range.max == kAnyNumber.max)
        s << "the numbers from " << range.min << " up";
    else
        s << "[" << range.min << ", " << range.max << "]";
    throw ConfigError(s.str());
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
    if (const auto text = textOf(name))
    {
        const auto number = numberIn<double>(*text);
        if (!number) throw ConfigError(keyAt(name) + " is not a number: '" + *text + "'");
        value = *number;
    }
    checkRange(name, value, range);
    record(name, numberText(value), doc);
}

void ConfigSection::key(const std::string& name, int& value, Range range, const std::string& doc)
{
    if (const auto text = textOf(name))
    {
        const auto number = numberIn<int>(*text);
        if (!number) throw ConfigError(keyAt(name) + " is not a whole number: '" + *text + "'");
        value = *number;
    }
    checkRange(name, value, range);
    record(name, std::to_string(value), doc);
}

void ConfigSection::key(const std::string& name, bool& value, const std::string& doc)
{
    if (const auto text = textOf(name))
    {
        if (*text != "true" && *text != "false")
            throw ConfigError(keyAt(name) + " is neither true nor false: '" + *text + "'");
        value = *text == "true";
    }
    record(name, value ? "true" : "false", doc);
}

void ConfigSection::key(const std::string& name, std::string& value, const std::string& doc)
{
    if (const auto text = textOf(name)) value = *text;
    record(name, quotedYaml(value), doc);
}

void ConfigSection::key(
    const std::string& name, std::vector<double>& value, Range range, const std::string& doc)
{
    if (const YamlNode* given = node_.find(name))
    {
        if (given->kind != YamlNode::Kind::List)
            throw ConfigError(keyAt(name) + " is not a list of numbers");
        value.clear();
        for (const YamlNode& item : given->list)
        {
            const auto number = numberIn<double>(item.scalar);
            if (item.kind != YamlNode::Kind::Scalar || !number)
                throw ConfigError(
                    keyAt(name) + " has an item that is not a number: '" + item.scalar + "'");
            value.push_back(*number);
        }
    }
    std::string text;
    for (const double v : value)
    {
        checkRange(name, v, range);
        text += (text.empty() ? "" : ", ") + numberText(v);
    }
    record(name, "[" + text + "]", doc);
}

ConfigSection& ConfigSection::section(const std::string& name)
{
    for (auto& e : entries_)
        if (e.child && e.name == name) return *e.child;
    Entry e;
    e.name = name;
    const YamlNode* child = node_.find(name);
    e.child = std::make_unique<ConfigSection>(
        child != nullptr ? *child : YamlNode(), pathOf(name), file_);
    entries_.push_back(std::move(e));
    return *entries_.back().child;
}

void ConfigSection::lay(const std::string& section, const std::string& name, double value)
{
    node_.section(section).set(name, numberText(value));
}

void ConfigSection::lay(const std::string& section, const std::string& name, bool value)
{
    node_.section(section).set(name, value ? "true" : "false");
}

void ConfigSection::rejectUnknown() const
{
    for (const YamlNode::Entry& given : node_.map)
    {
        bool known = false;
        for (const auto& e : entries_) known = known || e.name == given.key;
        if (known) continue;
        std::string message = lineOf(given.line) + "unknown configuration key '" +
                              pathOf(given.key) + "'; known here:";
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
    std::string message = keyAt(name) + " is '" + text + "'; choose from:";
    for (const auto& k : known) message += " " + k;
    throw ConfigError(message);
}
}  // namespace taut
