#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>

#include "CommandTable.h"

namespace taut
{
namespace
{
/** Text as groff shall print it: signs that mean something to groff, or that it would print as
 * others, which could not be copied to a command line. */
std::string escaped(const std::string& text)
{
    static const std::map<char, std::string> signs{{'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"},
                                                   {'`', "\\(ga"}, {'^', "\\(ha"}, {'~', "\\(ti"}};
    std::string result;
    for (const char c : text)
    {
        const auto sign = signs.find(c);
        result += sign == signs.end() ? std::string{c} : sign->second;
    }
    const bool is_request = !result.empty() && result.front() == '.';
    return is_request ? "\\&" + result : result;
}

std::string bold(const std::string& text)
{
    return "\\fB" + escaped(text) + "\\fR";
}

std::string italic(const std::string& text)
{
    return "\\fI" + escaped(text) + "\\fR";
}

/** Options are literal, other words stand for a value. */
std::string synopsisWord(const std::string& word)
{
    if (word == "[options]") return "[" + italic("options") + "]";
    return word.front() == '-' ? bold(word) : italic(word);
}

std::string synopsisLine(const CommandTable& table, const std::string& synopsis)
{
    std::string line = bold(table.program);
    std::size_t begin = 0;
    while (begin < synopsis.size())
    {
        const std::size_t end = std::min(synopsis.find(' ', begin), synopsis.size());
        line += " " + synopsisWord(synopsis.substr(begin, end - begin));
        begin = end + 1;
    }
    return line;
}

std::string paragraph(const std::string& title, const std::string& text)
{
    return ".TP\n" + title + "\n" + escaped(text) + "\n";
}

std::string entryParagraph(const TableEntry& entry)
{
    std::string title;
    for (const std::string& spelling : entry.spellings())
        title += (title.empty() ? "" : ", ") + bold(spelling);
    if (!entry.value.empty()) title += (title.empty() ? "" : " ") + italic(entry.value);
    return paragraph(title, entry.description + (entry.repeated ? " (may be repeated)" : "") + ".");
}

std::string heading(const std::string& title)
{
    return ".SH " + title + "\n";
}

/** The pages of the other programs, and where the documentation is. */
std::string relatedPages(const std::string& program)
{
    std::istringstream programs(TAUT_PROGRAMS);
    std::string text;
    for (std::string other; programs >> other;)
        if (other != program) text += bold(other) + "(1), ";
    return text + "and below the prefix of the installation " + italic(TAUT_DOCUMENTATION_FOLDER) +
           ".";
}

std::string sentences(const CommandTable& table)
{
    std::string text = table.summary + ". " + table.details;
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text;
}

std::string upperCase(std::string text)
{
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
}
}  // namespace

std::string manualPage(const CommandTable& table)
{
    // Without a date: the same sources give the same page on every day.
    std::string page = ".TH " + escaped(upperCase(table.program)) + " 1 \"\" \"taut " +
                       escaped(table.version) + "\" \"User Commands\"\n";
    // Left adjusted, words whole: paths and options are not torn.
    page += ".ad l\n.nh\n";
    page += heading("NAME") + escaped(table.program) + " \\- " + escaped(table.summary) + "\n";
    page += heading("SYNOPSIS");
    for (const std::string& synopsis : table.synopses)
        page += synopsisLine(table, synopsis) + "\n.br\n";
    page += heading("DESCRIPTION") + escaped(sentences(table)) + "\n";
    for (const bool required : {true, false})
    {
        std::string entries;
        for (const TableEntry& entry : table.entries)
            if (entry.required == required) entries += entryParagraph(entry);
        if (!entries.empty()) page += heading(required ? "REQUIRED" : "OPTIONS") + entries;
    }
    if (!table.exit_codes.empty()) page += heading("EXIT STATUS");
    for (const std::string& code : table.exit_codes)
    {
        const auto space = code.find(' ');
        page += paragraph(bold(code.substr(0, space)), code.substr(space + 1) + ".");
    }
    page += heading("EXAMPLES") + ".nf\n";
    for (const std::string& example : table.examples)
        page += escaped(table.program + " " + example) + "\n";
    page += ".fi\n";
    const auto has_config = [](const TableEntry& entry) { return entry.name == "config"; };
    if (std::any_of(table.entries.begin(), table.entries.end(), has_config))
        page += heading("FILES") +
                paragraph(
                    italic(TAUT_CONFIG_FOLDER),
                    "The folder config of an installation, below its prefix (as /usr): method "
                    "files, an example of a rig file, scenarios.");
    page += heading("SEE ALSO");
    return page + relatedPages(table.program) + "\n";
}
}  // namespace taut
