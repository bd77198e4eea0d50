#include "CommandTable.h"

#include <cctype>
#include <sstream>

namespace taut
{
namespace
{
constexpr std::size_t kWidth = 90;

/** Splits "0 done, 1 failed" before each digit that follows a comma. */
std::vector<std::string> splitExitCodes(const std::string& text)
{
    std::vector<std::string> codes;
    std::size_t begin = 0;
    for (std::size_t comma = text.find(", "); comma != std::string::npos;
         comma = text.find(", ", comma + 1))
    {
        if (std::isdigit(static_cast<unsigned char>(text[comma + 2])) == 0) continue;
        codes.push_back(text.substr(begin, comma - begin));
        begin = comma + 2;
    }
    codes.push_back(text.substr(begin));
    return codes;
}

void dropEnd(std::string& text, char last)
{
    if (!text.empty() && text.back() == last) text.pop_back();
}

/** Text in lines of kWidth that begin with so many spaces. */
std::string wrapped(const std::string& text, std::size_t indent)
{
    std::istringstream words(text);
    std::string word, line, lines;
    const auto end_line = [&]
    {
        if (!line.empty()) lines += std::string(indent, ' ') + line + "\n";
        line.clear();
    };
    while (words >> word)
    {
        if (indent + line.size() + 1 + word.size() > kWidth) end_line();
        line += (line.empty() ? "" : " ") + word;
    }
    end_line();
    return lines;
}

std::string joined(const std::vector<std::string>& parts, const std::string& between)
{
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
    return text;
}

std::string entryText(const TableEntry& entry)
{
    std::vector<std::string> title{joined(entry.spellings(), ", ")};
    if (entry.isArgument()) title.clear();
    if (!entry.value.empty()) title.push_back(entry.value);
    return wrapped(joined(title, " "), 2) +
           wrapped(entry.description + (entry.repeated ? " (may be repeated)" : ""), 8);
}
}  // namespace

std::vector<std::string> TableEntry::spellings() const
{
    std::vector<std::string> all;
    if (!flag.empty()) all.push_back("-" + flag);
    if (!name.empty()) all.push_back("--" + name);
    return all;
}

void describe(const std::string& message, CommandTable& table)
{
    std::string text = message;
    const std::string name = table.program + ": ", codes = "Exit codes: ";
    if (text.compare(0, name.size(), name) == 0) text.erase(0, name.size());
    if (const auto at = text.find(codes); at != std::string::npos)
    {
        std::string all = text.substr(at + codes.size());
        dropEnd(all, '.');
        table.exit_codes = splitExitCodes(all);
        text.erase(at);
        dropEnd(text, ' ');
    }
    const auto end = text.find(". ");
    if (end != std::string::npos) table.details = text.substr(end + 2);
    table.summary = text.substr(0, end);
    dropEnd(table.summary, '.');
}

std::string helpText(const CommandTable& table)
{
    std::string message = table.program + ": " + table.summary + ". " + table.details;
    if (!table.exit_codes.empty())
        message += " Exit codes: " + joined(table.exit_codes, ", ") + ".";
    std::string text = wrapped(message, 0) + "\nUsage:\n";
    for (const std::string& synopsis : table.synopses)
        text += wrapped(table.program + " " + synopsis, 2);
    text += "\nExamples:\n";
    for (const std::string& example : table.examples)
        text += "  " + table.program + " " + example + "\n";
    for (const bool required : {true, false})
    {
        std::string entries;
        for (const TableEntry& entry : table.entries)
            if (entry.required == required) entries += entryText(entry);
        if (!entries.empty()) text += (required ? "\nRequired:\n" : "\nOptions:\n") + entries;
    }
    return text;
}
}  // namespace taut
