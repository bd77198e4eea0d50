#include "CommandLine.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <thread>

#include "CommandTable.h"
#include "Commit.h"

namespace taut
{
namespace
{
using Arguments = std::vector<TCLAP::Arg*>;

bool isBuiltIn(const TCLAP::Arg* arg)
{
    const std::string& name = arg->getName();
    return name == "help" || name == "version" || name == TCLAP::Arg::ignoreNameString();
}

/** In the order of their declaration, those of TCLAP itself last. TCLAP keeps them backward. */
Arguments argumentsOf(TCLAP::CmdLineInterface& cmd)
{
    const std::list<TCLAP::Arg*>& backward = cmd.getArgList();
    Arguments arguments(backward.rbegin(), backward.rend());
    std::stable_partition(
        arguments.begin(), arguments.end(), [](const auto* arg) { return !isBuiltIn(arg); });
    return arguments;
}

/** What stands for its value, as "LOG.rawlog"; empty for a switch. */
std::string valueOf(const TCLAP::Arg& arg)
{
    const std::string id = arg.longID();
    const auto begin = id.find('<'), end = id.find('>');
    return begin == std::string::npos ? "" : id.substr(begin + 1, end - begin - 1);
}

/** Without a name on the command line: its value alone stands there. */
bool isPositional(const TCLAP::Arg& arg)
{
    return arg.longID().front() == '<';
}

/** "option -i/--input" or "argument SOURCE". */
std::string titleOf(const TCLAP::Arg& arg)
{
    if (isPositional(arg)) return "argument " + valueOf(arg);
    const std::string flag = arg.getFlag().empty() ? "" : "-" + arg.getFlag() + "/";
    return "option " + flag + "--" + arg.getName();
}

/** Insertions, deletions and replacements of a letter that make one of the other (Levenshtein). */
std::size_t editDistance(const std::string& a, const std::string& b)
{
    std::vector<std::size_t> row(b.size() + 1);  // distances of the first i letters of a
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); i++)
    {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); j++)
        {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j + 1] + 1, row[j] + 1});
        }
    }
    return row.back();
}

/** The option that was probably meant; empty where none is near. */
std::string nearestOption(const std::string& wrong, const Arguments& arguments)
{
    std::string nearest;
    std::size_t least = 2 + wrong.size() / 4;
    for (const TCLAP::Arg* arg : arguments)
    {
        if (isPositional(*arg)) continue;
        const std::string option = "--" + arg->getName();
        const std::size_t distance = editDistance(wrong, option);
        if (distance >= least) continue;
        least = distance;
        nearest = option;
    }
    return nearest;
}

UsageError unknownOption(const std::string& wrong, const Arguments& arguments)
{
    const std::string text = "unknown option '" + wrong + "'";
    const std::string name = wrong.substr(0, wrong.find('='));
    const std::string nearest = nearestOption(name, arguments);
    if (nearest.empty()) return UsageError(text);
    // TCLAP takes the word after the option for its value, and nothing after a '='.
    const std::string value =
        name.size() < wrong.size() ? " " + wrong.substr(name.size() + 1) : std::string();
    return UsageError(text + "; did you mean '" + nearest + value + "'?");
}

/** Several switches of one letter in one word, as "-wq". */
bool isSwitches(const std::string& word, const Arguments& arguments)
{
    return word.size() > 1 && word[1] != '-' &&
           std::all_of(
               word.begin() + 1, word.end(),
               [&](char letter)
               {
                   return std::any_of(
                       arguments.begin(), arguments.end(),
                       [letter](const TCLAP::Arg* arg) {
                           return !arg->isValueRequired() && arg->getFlag() == std::string{letter};
                       });
               });
}

/** Throws UsageError for an option that is none. TCLAP alone would take it for a positional
 * argument where there is one. */
void rejectUnknownOptions(const std::vector<std::string>& words, const Arguments& arguments)
{
    for (std::size_t i = 0; i < words.size() && words[i] != "--"; i++)
    {
        const std::string& word = words[i];
        if (word.size() < 2 || word[0] != '-') continue;
        const auto known = std::find_if(
            arguments.begin(), arguments.end(),
            [&](const TCLAP::Arg* arg) { return !isPositional(*arg) && arg->argMatches(word); });
        if (known != arguments.end())
            i += (*known)->isValueRequired() ? 1 : 0;
        else if (!isSwitches(word, arguments))
            throw unknownOption(word, arguments);
    }
}

std::string quotedForShell(const std::string& word)
{
    const bool plain =
        !word.empty() &&
        std::all_of(
            word.begin(), word.end(),
            [](unsigned char c)
            {
                return std::isalnum(c) != 0 ||
                       std::string("_./:=,@%+-").find(static_cast<char>(c)) != std::string::npos;
            });
    if (plain) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string{c};
    return quoted + "'";
}

/** As the table of the program tells it. What TCLAP adds itself is told in taut's words. */
TableEntry entryOf(TCLAP::Arg& arg)
{
    const std::string& name = arg.getName();
    if (name == "help") return {"h", name, "", "Print what the program does and its options"};
    if (name == "version")
        return {"", name, "", "Print the version and the commit it was built of"};
    if (name == TCLAP::Arg::ignoreNameString()) return {"-", "", "", "What follows is no option"};
    std::string description = arg.getDescription();
    const std::string label = "(required)  ";  // of TCLAP; here a heading says so
    if (description.compare(0, label.size(), label) == 0) description.erase(0, label.size());
    const bool positional = isPositional(arg);
    return {
        positional ? "" : arg.getFlag(),
        positional ? "" : name,
        valueOf(arg),
        description,
        arg.isRequired(),
        arg.acceptsMultipleValues()};
}

std::string synopsisOf(const std::vector<TableEntry>& entries)
{
    std::string text;
    for (const TableEntry& entry : entries)
    {
        if (!entry.required) continue;
        if (!entry.isArgument()) text += entry.spellings().front() + " ";
        text += entry.value + " ";
    }
    return text + "[options]";
}

CommandTable tableOf(TCLAP::CmdLineInterface& cmd, const std::string& program, const Usage& usage)
{
    CommandTable table;
    table.program = program;
    table.version = cmd.getVersion();
    describe(cmd.getMessage(), table);
    for (TCLAP::Arg* arg : argumentsOf(cmd))
    {
        const auto& also = usage.required;
        table.entries.push_back(entryOf(*arg));
        if (std::find(also.begin(), also.end(), arg) != also.end())
            table.entries.back().required = true;
    }
    table.synopses.push_back(synopsisOf(table.entries));
    if (usage.alone != nullptr)
    {
        const std::string value = valueOf(*usage.alone);
        table.synopses.push_back(
            "--" + usage.alone->getName() + (value.empty() ? "" : " " + value) + " [options]");
    }
    table.examples = usage.examples;
    return table;
}

/** The build makes the manual page and the completion with options that users need not know. */
bool printMadeFromTable(const CommandTable& table, const std::string& option)
{
    if (option == "--print-manual-page")
        std::cout << manualPage(table);
    else if (option == "--print-bash-completion")
        std::cout << bashCompletion(table);
    else
        return false;
    return true;
}

/** What TCLAP says, in taut's words. */
class Output : public TCLAP::StdOutput
{
 public:
    Output(std::string program, const Usage& usage) : program_(std::move(program)), usage_(usage) {}

    /** The required arguments are missing, but an option that needs none is there. */
    bool complete() const { return complete_; }

    void usage(TCLAP::CmdLineInterface& cmd) override
    {
        std::cout << helpText(tableOf(cmd, program_, usage_));
    }

    void version(TCLAP::CmdLineInterface& cmd) override
    {
        std::cout << program_ << " " << cmd.getVersion() << " (commit " << kCommit << ")\n";
    }

    void failure(TCLAP::CmdLineInterface& cmd, TCLAP::ArgException& e) override
    {
        const Arguments arguments = argumentsOf(cmd);
        const std::string id = e.argId(), prefix = "Argument: ";
        if (id.compare(0, prefix.size(), prefix) != 0) return missing(arguments);  // names none
        const std::string culprit = id.substr(prefix.size());
        for (const TCLAP::Arg* arg : arguments)
            if (arg->toString() == culprit) throw UsageError(titleOf(*arg) + ": " + e.error());
        throw UsageError("unexpected argument '" + culprit + "'");
    }

 private:
    void missing(const Arguments& arguments)
    {
        complete_ = usage_.alone != nullptr && usage_.alone->isSet();
        if (complete_) return;
        std::string titles;
        int count = 0;
        for (const TCLAP::Arg* arg : arguments)
        {
            if (!arg->isRequired() || arg->isSet()) continue;
            titles += (count++ == 0 ? "" : " and ") + titleOf(*arg);
        }
        throw UsageError(titles + (count > 1 ? " are required" : " is required"));
    }

    std::string program_;
    const Usage& usage_;
    bool complete_ = false;
};
}  // namespace

bool parseCommandLine(TCLAP::CmdLine& cmd, int argc, char** argv, const Usage& usage)
{
    const std::string program = std::filesystem::path(argv[0]).filename().string();
    if (argc == 2 && printMadeFromTable(tableOf(cmd, program, usage), argv[1])) return false;
    rejectUnknownOptions({argv + 1, argv + argc}, argumentsOf(cmd));
    Output output(program, usage);
    const std::unique_ptr<TCLAP::CmdLineOutput> replaced(cmd.getOutput());  // TCLAP would leak it
    cmd.setOutput(&output);
    return cmd.parse(argc, argv) || output.complete();
}

std::string commandLineWith(
    const std::vector<std::string>& words, const std::string& option, const std::string& value)
{
    std::vector<std::string> changed;
    for (std::size_t i = 0; i < words.size(); i++)
        if (words[i] == option)
            i++;  // its value
        else
            changed.push_back(words[i]);
    changed.insert(changed.end(), {option, value});
    std::string line;
    for (const std::string& word : changed)
        line += (line.empty() ? "" : " ") + quotedForShell(word);
    return line;
}

int threadsOf(int asked)
{
    if (asked < 0 || asked > 256) throw UsageError("--threads must be 0 to 256");
    return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void guardStandardStreams()
{
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    // open() gives the lowest descriptor that is free: those below it are open already.
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
        if (::fcntl(fd, F_GETFD) == -1 && ::open("/dev/null", O_RDWR) != fd)
            throw std::runtime_error("cannot open /dev/null for a closed standard stream");
}

bool flushStandardOutput()
{
    std::cout.flush();
    return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
}
}  // namespace taut
