#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace taut
{
/** A configuration that cannot be used; what() names file, line and key. */
struct ConfigError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/** A value of a YAML file: nothing, a text, a list, or a map whose entries keep their order. */
class YamlNode
{
 public:
    enum class Kind
    {
        Null,
        Scalar,
        List,
        Map
    };
    struct Entry;

    YamlNode() = default;
    explicit YamlNode(std::string text) : kind(Kind::Scalar), scalar(std::move(text)) {}

    bool isNull() const { return kind == Kind::Null; }
    bool isMap() const { return kind == Kind::Map; }

    /** The value of a key; null if this is no map or has no such key. */
    const YamlNode* find(const std::string& key) const;

    /** The map at that path, "section.subsection", made where it is not there. Empty: this. Throws
     * ConfigError if something on the way is no map. */
    YamlNode& section(const std::string& path);

    /** Gives a key of this map a new value. */
    void set(const std::string& key, const std::string& value);

    Kind kind = Kind::Null;
    int line = 0;  //!< from 1; 0: not of a file
    std::string scalar;
    std::vector<YamlNode> list;
    std::vector<Entry> map;
};

struct YamlNode::Entry
{
    std::string key;
    YamlNode value;
    int line = 0;  //!< of the key
};

/** Reads one YAML document; `name` stands for the file in messages. Throws ConfigError, with the
 * line, on whatever is not understood to its last byte: bytes that are not UTF-8, syntax errors, a
 * key that is given twice, anchors and aliases, more than one document, more than 64 levels, more
 * than a megabyte. */
YamlNode parseYaml(const std::string& text, const std::string& name = "");

/** YAML text that parseYaml() reads back to the same values. */
std::string yamlText(const YamlNode& node);

/** The text of a configuration file. Throws ConfigError if it is no regular file or cannot be read.
 */
std::string readTextFile(const std::string& path);

/** parseYaml() of a file. Throws ConfigError also if it is no regular file or cannot be read. */
YamlNode readYamlFile(const std::string& path);
}  // namespace taut
