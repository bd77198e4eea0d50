#include <algorithm>
#include <array>

#include "CommandTable.h"

namespace taut
{
namespace
{
/** Functions that every script brings along: one may be loaded without the others. */
constexpr const char* kFunctions = R"bash(
# Files whose names end in $1, and folders; any file where none does, or without $1.
_taut_files()
{
    compopt -o filenames 2> /dev/null
    [[ ! ${1-} ]] || mapfile -t COMPREPLY < <(compgen -o plusdirs -f -X "!*$1" -- "$_taut_word")
    [[ ${#COMPREPLY[@]} -gt 0 ]] || mapfile -t COMPREPLY < <(compgen -f -- "$_taut_word")
}

_taut_folders()
{
    compopt -o filenames 2> /dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$_taut_word")
}

# The words of $1.
_taut_words()
{
    mapfile -t COMPREPLY < <(compgen -W "$1" -- "$_taut_word")
}

# Nothing to offer: no files either, which readline would name.
_taut_none()
{
    compopt +o default 2> /dev/null
}

# Keys of the method file, as the taut-slam beside program $1 has them. A value is up to the user.
_taut_keys()
{
    _taut_none
    [[ $_taut_word != *=* ]] || return
    compopt -o nospace 2> /dev/null
    local slam=taut-slam
    [[ $1 != */* ]] || slam=${1%/*}/taut-slam
    _taut_words "$("$slam" --show-config 2> /dev/null | awk '
        { depth = (match($0, /[^ ]/) - 1) / 2; sub(/^ */, ""); name = $0; sub(/:.*/, "", name) }
        { path[depth] = (depth > 0 ? path[depth - 1] "." : "") name }
        !/:$/ { print path[depth] "=" }')"
}
)bash";

bool endsWith(const std::string& text, const std::string& end)
{
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/** The call that offers what may stand for a value: "OUT/" is a folder, "LOG.rawlog" a file that
 * ends so, "start|end" one of these words. */
std::string offerOf(const std::string& value)
{
    static const std::array<std::string, 3> any_file{"FILE", "SOURCE", "RECORDING"};
    if (value == "SECTION.KEY=VALUE") return "_taut_keys \"$1\"";
    if (endsWith(value, "/") || value == "FOLDER") return "_taut_folders";
    if (std::find(any_file.begin(), any_file.end(), value) != any_file.end()) return "_taut_files";
    if (value.find('|') != std::string::npos)
    {
        std::string words = value;
        std::replace(words.begin(), words.end(), '|', ' ');
        return "_taut_words '" + words + "'";
    }
    const auto dot = value.rfind('.');
    const bool has_ending = dot != std::string::npos && dot + 1 < value.size() &&
                            std::all_of(
                                value.begin() + static_cast<std::ptrdiff_t>(dot) + 1, value.end(),
                                [](char c) { return c >= 'a' && c <= 'z'; });
    return has_ending ? "_taut_files " + value.substr(dot) : "_taut_none";
}

std::string joined(const std::vector<std::string>& parts, const std::string& between)
{
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
    return text;
}
}  // namespace

std::string bashCompletion(const CommandTable& table)
{
    std::string function = "_" + table.program;
    std::replace(function.begin(), function.end(), '-', '_');
    std::string options, cases, argument;
    for (const TableEntry& entry : table.entries)
    {
        if (entry.isArgument())
        {
            argument = offerOf(entry.value);
            continue;
        }
        options += (options.empty() ? "" : " ") + joined(entry.spellings(), " ");
        if (entry.value.empty()) continue;
        cases += "        " + joined(entry.spellings(), " | ") + ") " + offerOf(entry.value) +
                 "; return ;;\n";
    }
    // An empty word: what stands without a name, where the program takes that; else the options.
    const std::string offer_argument =
        argument.empty() ? "" : "    [[ $_taut_word == -* ]] || { " + argument + "; return; }\n";
    return "# bash completion of " + table.program + " " + table.version +
           "; made from the table of its options, as --help is.\n" + kFunctions + "\n" + function +
           "()\n{\n    local _taut_word=${COMP_WORDS[COMP_CWORD]}\n    COMPREPLY=()\n"
           "    case ${COMP_WORDS[COMP_CWORD - 1]} in\n" +
           cases + "    esac\n" + offer_argument + "    _taut_words '" + options +
           "'\n}\n\ncomplete -o default -F " + function + " " + table.program + "\n";
}
}  // namespace taut
