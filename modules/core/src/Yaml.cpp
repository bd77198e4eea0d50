#include "taut/core/Yaml.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "taut/core/format.h"
#include "taut/core/quotedYaml.h"

namespace taut
{
namespace
{
constexpr std::size_t kMostBytes = 1 << 20;
constexpr std::size_t kMostLevels = 64;

std::string place(const std::string& name, int line)
{
    const std::string file = name.empty() ? "line " : name + ":";
    return file + std::to_string(line) + ": ";
}

/** Length of the UTF-8 character at the beginning of `s`; 0 if there is none. Overlong forms and
 * surrogates are none (RFC 3629). */
std::size_t characterLength(const unsigned char* s, std::size_t left)
{
    const auto follows = [&](std::size_t n, unsigned char low, unsigned char high)
    {
        if (left <= n || s[1] < low || s[1] > high) return false;
        for (std::size_t i = 2; i <= n; i++)
            if (s[i] < 0x80 || s[i] > 0xbf) return false;
        return true;
    };
    if (s[0] < 0x80) return 1;
    if (s[0] >= 0xc2 && s[0] <= 0xdf && follows(1, 0x80, 0xbf)) return 2;
    if (s[0] == 0xe0 && follows(2, 0xa0, 0xbf)) return 3;
    if (s[0] == 0xed && follows(2, 0x80, 0x9f)) return 3;
    if (s[0] >= 0xe1 && s[0] <= 0xef && s[0] != 0xed && follows(2, 0x80, 0xbf)) return 3;
    if (s[0] == 0xf0 && follows(3, 0x90, 0xbf)) return 4;
    if (s[0] >= 0xf1 && s[0] <= 0xf3 && follows(3, 0x80, 0xbf)) return 4;
    if (s[0] == 0xf4 && follows(3, 0x80, 0x8f)) return 4;
    return 0;
}

void checkText(const std::string& text, const std::string& name)
{
    if (text.size() > kMostBytes)
        throw ConfigError(
            place(name, 1) + "it has " + std::to_string(text.size()) +
            " bytes, more than any configuration");
    const auto* bytes = reinterpret_cast<const unsigned char*>(text.data());
    int line = 1;
    for (std::size_t i = 0; i < text.size();)
    {
        const std::size_t n = characterLength(bytes + i, text.size() - i);
        if (n == 0)
            throw ConfigError(
                place(name, line) + "a byte that is not UTF-8; save the file as UTF-8 text");
        const unsigned char c = bytes[i];
        if ((c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7f)
            throw ConfigError(place(name, line) + "a control character; this is no text file");
        if (c == '\n') line++;
        i += n;
    }
}

/** Builds the tree from the parser's events, which come with their lines. */
class TreeBuilder : public YAML::EventHandler
{
 public:
    TreeBuilder(const std::string& text, const std::string& name) : text_(text), name_(name) {}

    YamlNode take() { return std::move(root_); }

    void OnDocumentStart(const YAML::Mark&) override {}
    void OnDocumentEnd() override {}
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { refuseAnchor(mark); }
    void OnAnchor(const YAML::Mark& mark, const std::string&) override { refuseAnchor(mark); }

    void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add(node(mark)); }

    void OnScalar(
        const YAML::Mark& mark, const std::string&, YAML::anchor_t,
        const std::string& value) override
    {
        if (wantsKey())
        {
            addKey(mark, value);
            return;
        }
        checkQuote(mark);
        YamlNode scalar = node(mark);
        scalar.kind = YamlNode::Kind::Scalar;
        scalar.scalar = value;
        add(std::move(scalar));
    }

    void OnSequenceStart(
        const YAML::Mark& mark, const std::string&, YAML::anchor_t,
        YAML::EmitterStyle::value) override
    {
        open(mark, YamlNode::Kind::List);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapStart(
        const YAML::Mark& mark, const std::string&, YAML::anchor_t,
        YAML::EmitterStyle::value) override
    {
        open(mark, YamlNode::Kind::Map);
    }
    void OnMapEnd() override { close(); }

 private:
    struct Open
    {
        YamlNode node;
        bool key_given = false;            // of a map: the next event is its value
        std::map<std::string, int> lines;  // of the keys of a map
    };

    static YamlNode node(const YAML::Mark& mark)
    {
        YamlNode n;
        n.line = mark.line + 1;
        return n;
    }

    bool wantsKey() const
    {
        return !open_.empty() && open_.back().node.isMap() && !open_.back().key_given;
    }

    void addKey(const YAML::Mark& mark, const std::string& key)
    {
        Open& map = open_.back();
        const int line = mark.line + 1;
        const auto [first, is_new] = map.lines.emplace(key, line);
        if (!is_new)
            throw ConfigError(
                place(name_, line) + "'" + key + "' is given again; the first one is in line " +
                std::to_string(first->second));
        map.node.map.push_back({key, {}, line});
        map.key_given = true;
    }

    void add(YamlNode value)
    {
        if (wantsKey()) throw ConfigError(place(name_, value.line) + "a key was expected");
        if (open_.empty())
        {
            root_ = std::move(value);
            return;
        }
        Open& parent = open_.back();
        if (parent.node.isMap())
            parent.node.map.back().value = std::move(value);
        else
            parent.node.list.push_back(std::move(value));
        parent.key_given = false;
    }

    void open(const YAML::Mark& mark, YamlNode::Kind kind)
    {
        if (wantsKey()) throw ConfigError(place(name_, mark.line + 1) + "a key was expected");
        if (open_.size() == kMostLevels)
            throw ConfigError(
                place(name_, mark.line + 1) + "more than " + std::to_string(kMostLevels) +
                " levels of nesting");
        open_.push_back({node(mark), false, {}});
        open_.back().node.kind = kind;
    }

    void close()
    {
        YamlNode done = std::move(open_.back().node);
        open_.pop_back();
        add(std::move(done));
    }

    [[noreturn]] void refuseAnchor(const YAML::Mark& mark) const
    {
        throw ConfigError(
            place(name_, mark.line + 1) + "anchors (&) and aliases (*) are not supported");
    }

    /** The parser takes a quote that is never closed for one that ends with the file. */
    void checkQuote(const YAML::Mark& mark) const
    {
        if (mark.pos < 0 || static_cast<std::size_t>(mark.pos) >= text_.size()) return;
        std::size_t i = static_cast<std::size_t>(mark.pos);
        const char quote = text_[i++];
        if (quote != '\'' && quote != '"') return;
        const auto isEscape = [&]
        { return quote == '"' ? text_[i] == '\\' : text_.compare(i, 2, "''") == 0; };
        while (i < text_.size() && (text_[i] != quote || isEscape())) i += isEscape() ? 2 : 1;
        if (i >= text_.size())
            throw ConfigError(place(name_, mark.line + 1) + "a quote that is never closed");
    }

    const std::string& text_;
    const std::string& name_;
    YamlNode root_;
    std::vector<Open> open_;
};
}  // namespace

const YamlNode* YamlNode::find(const std::string& key) const
{
    const auto it =
        std::find_if(map.begin(), map.end(), [&](const Entry& e) { return e.key == key; });
    return it == map.end() ? nullptr : &it->value;
}

YamlNode& YamlNode::section(const std::string& path)
{
    if (isNull()) kind = Kind::Map;
    if (!isMap()) throw ConfigError("a value stands where a section was expected");
    if (path.empty()) return *this;
    const auto dot = path.find('.');
    const std::string first = path.substr(0, dot);
    auto it = std::find_if(map.begin(), map.end(), [&](const Entry& e) { return e.key == first; });
    if (it == map.end()) it = map.insert(it, {first, {}, 0});
    return it->value.section(dot == std::string::npos ? "" : path.substr(dot + 1));
}

void YamlNode::set(const std::string& key, const std::string& value)
{
    for (Entry& e : map)
    {
        if (e.key != key) continue;
        e.value = YamlNode(value);
        return;
    }
    map.push_back({key, YamlNode(value), 0});
}

YamlNode parseYaml(const std::string& text, const std::string& name)
{
    checkText(text, name);
    const bool marked = text.compare(0, 3, "\xef\xbb\xbf") == 0;  // byte order mark
    const std::string body = marked ? text.substr(3) : text;
    std::istringstream in(body);
    TreeBuilder builder(body, name);
    try
    {
        YAML::Parser parser(in);
        parser.HandleNextDocument(builder);
        YamlNode tree = builder.take();
        TreeBuilder rest(body, name);
        if (parser.HandleNextDocument(rest))
            throw ConfigError(
                place(name, rest.take().line) + "a second document, or text after the end");
        return tree;
    }
    catch (const YAML::Exception& e)
    {
        throw ConfigError(place(name, e.mark.line + 1) + e.msg);
    }
}

std::string quotedYaml(const std::string& text)
{
    const auto isControl = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
    std::string quoted;
    if (std::none_of(text.begin(), text.end(), isControl))
    {
        for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
        return "'" + quoted + "'";
    }
    // Between single quotes, the end of a line would be a blank.
    for (const char c : text)
        if (isControl(static_cast<unsigned char>(c)))
            quoted += format("\\x%02x", static_cast<unsigned>(c));
        else
            quoted += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
    return "\"" + quoted + "\"";
}

namespace
{
/** As a flow value, quoted, or as a block that begins on a line of its own. */
void print(const YamlNode& node, int indent, std::string& out)
{
    switch (node.kind)
    {
        case YamlNode::Kind::Null:
            out += "\n";
            return;
        case YamlNode::Kind::Scalar:
            out += " " + quotedYaml(node.scalar) + "\n";
            return;
        case YamlNode::Kind::List:
            if (node.list.empty()) out += " []";
            out += "\n";
            for (const YamlNode& item : node.list)
            {
                out += std::string(static_cast<std::size_t>(indent), ' ') + "-";
                print(item, indent + 2, out);
            }
            return;
        case YamlNode::Kind::Map:
            if (node.map.empty()) out += indent > 0 ? " {}" : "{}";
            if (indent > 0 || node.map.empty()) out += "\n";
            for (const YamlNode::Entry& entry : node.map)
            {
                out += std::string(static_cast<std::size_t>(indent), ' ') + quotedYaml(entry.key) +
                       ":";
                print(entry.value, indent + 2, out);
            }
            return;
    }
}
}  // namespace

std::string yamlText(const YamlNode& node)
{
    std::string out;
    print(node, 0, out);
    return out;
}

std::string readTextFile(const std::string& path)
{
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw ConfigError("'" + path + "' is not there");
    // Others, as a pipe that nobody writes to, could be waited for without end.
    if (status.type() != std::filesystem::file_type::regular)
        throw ConfigError("'" + path + "' is not a file");
    std::ifstream file(path, std::ios::binary);
    std::string text;
    char buffer[4096];
    while (file.read(buffer, sizeof buffer) || file.gcount() > 0)
    {
        text.append(buffer, static_cast<std::size_t>(file.gcount()));
        if (text.size() > kMostBytes) break;
    }
    if (!file.is_open() || file.bad())
        throw ConfigError("'" + path + "' cannot be read: " + std::strerror(errno));
    return text;
}

YamlNode readYamlFile(const std::string& path)
{
    return parseYaml(readTextFile(path), path);
}
}  // namespace taut
