#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "program.h"
#include "temporary_folder.h"

/** The manual page and the bash completion of each program, as the build leaves them. */
namespace
{
using namespace taut::test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;
using testing::UnorderedElementsAre;
using testing::UnorderedElementsAreArray;

using Words = std::vector<std::string>;

Words wordsOf(const std::string& text)
{
    std::istringstream words(text);
    return {std::istream_iterator<std::string>(words), {}};
}

/** With single spaces: lines may be broken anywhere. */
std::string inOneLine(const std::string& text)
{
    std::string line;
    for (const std::string& word : wordsOf(text)) line += (line.empty() ? "" : " ") + word;
    return line;
}

/** An option as --help tells it. */
struct HelpEntry
{
    std::string title;  //!< "-i, --input LOG.rawlog"
    std::string description;
};

std::vector<HelpEntry> entriesOf(const std::string& program)
{
    std::istringstream help(runProgram(TAUT_PROGRAMS "/" + program, "--help").output);
    std::vector<HelpEntry> entries;
    bool in_entries = false;
    for (std::string line; std::getline(help, line);)
    {
        const auto indent = line.find_first_not_of(' ');
        if (indent == 0) in_entries = line == "Required:" || line == "Options:";
        if (!in_entries) continue;
        if (indent == 2) entries.push_back({line.substr(2), ""});
        if (indent == 8) entries.back().description += line.substr(7);
    }
    return entries;
}

/** All ways to write the options of a program: "-i", "--input". */
Words optionsOf(const std::string& program)
{
    Words options;
    for (const HelpEntry& entry : entriesOf(program))
        for (std::string word : wordsOf(entry.title))
        {
            if (word.front() != '-') continue;
            if (word.back() == ',') word.pop_back();
            options.push_back(word);
        }
    return options;
}

/** What bash offers for the last word of a command line, in a folder. */
Words completed(const std::string& program, const std::string& line, const std::string& folder)
{
    // "complete -p" tells how the script registered its function: ... -F FUNCTION PROGRAM
    const std::string script =
        "source " TAUT_SHARE "/bash-completion/completions/" + program + "; cd " + folder +
        "; COMP_WORDS=(" TAUT_PROGRAMS "/" + program + " " + line +
        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); registered=($(complete -p " + program +
        ")); ${registered[-2]} ${COMP_WORDS[0]}; echo \"${COMPREPLY[@]}\"";
    return wordsOf(runProgram("bash -c '" + script + "'", "").output);
}

class TheManual : public testing::TestWithParam<std::string>
{
};

TEST_P(TheManual, CompletesEachOption)
{
    const std::string program = GetParam();
    const Words options = optionsOf(program);
    EXPECT_THAT(options, IsSupersetOf({"--help", "--version", "-h"}));
    EXPECT_THAT(completed(program, "-", "."), UnorderedElementsAreArray(options));
    for (const std::string& option : options)
    {
        if (option.compare(0, 2, "--") != 0 || option.size() < 5) continue;
        EXPECT_THAT(
            completed(program, option.substr(0, option.size() - 1), "."),
            testing::Contains(option));
    }
}

TEST_P(TheManual, PrintsWithoutWarnings)
{
    if (runProgram("command -v man", "").exit_code != 0) GTEST_SKIP() << "no man here";
    const std::string page = TAUT_SHARE "/man/man1/" + GetParam() + ".1";
    const ProgramRun warnings =
        runProgram("LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -l", page + " 2>&1 >/dev/null");
    EXPECT_EQ(warnings.exit_code, 0);
    EXPECT_EQ(warnings.output, "");
}

TEST_P(TheManual, TellsWhatHelpTells)
{
    if (runProgram("command -v man", "").exit_code != 0) GTEST_SKIP() << "no man here";
    const std::string program = GetParam();
    const std::string page = inOneLine(
        runProgram("LC_ALL=C MANWIDTH=80 man -l", TAUT_SHARE "/man/man1/" + program + ".1").output);
    EXPECT_THAT(page, HasSubstr("NAME " + program + " - "));
    EXPECT_THAT(page, HasSubstr(" SYNOPSIS " + program + " "));
    EXPECT_THAT(page, HasSubstr(" EXIT STATUS 0 "));
    EXPECT_THAT(page, HasSubstr(" EXAMPLES " + program + " "));
    EXPECT_THAT(page, Not(HasSubstr(".. ")));
    const std::vector<HelpEntry> entries = entriesOf(program);
    ASSERT_FALSE(entries.empty());
    for (const HelpEntry& entry : entries)
        EXPECT_THAT(page, HasSubstr(" " + entry.title + " " + inOneLine(entry.description) + "."))
            << entry.title;
}

INSTANTIATE_TEST_SUITE_P(
    Of, TheManual, testing::ValuesIn(wordsOf(TAUT_PROGRAM_NAMES)),
    [](const auto& test) { return test.param.substr(5); });

class TheCompletion : public testing::Test
{
 protected:
    TheCompletion()
    {
        namespace fs = std::filesystem;
        for (const char* folder : {"results", "recordings"}) fs::create_directory(folder_ / folder);
        for (const char* file : {"a.yaml", "b.yaml", "c.rawlog", "d.pcap", "results/e.yaml"})
            std::ofstream{folder_ / file};
    }

    Words slam(const std::string& line) const { return completed("taut-slam", line, folder_ / ""); }

    const TemporaryFolder folder_;
};

TEST_F(TheCompletion, OffersFilesThatFitAndFolders)
{
    EXPECT_THAT(
        slam(R"(-c "")"), UnorderedElementsAre("a.yaml", "b.yaml", "results", "recordings"));
    EXPECT_THAT(slam("--config a"), ElementsAre("a.yaml"));
    EXPECT_THAT(slam("-w -c results/"), ElementsAre("results/e.yaml"));
    EXPECT_THAT(
        completed("taut-import", R"("")", folder_ / ""),
        UnorderedElementsAre("a.yaml", "b.yaml", "c.rawlog", "d.pcap", "results", "recordings"));
}

TEST_F(TheCompletion, OffersAnyFileWhereNoneHasTheUsualEnding)
{
    EXPECT_THAT(slam("-c d"), ElementsAre("d.pcap"));
}

TEST_F(TheCompletion, OffersFoldersForResults)
{
    EXPECT_THAT(slam("-i a.rawlog -o re"), UnorderedElementsAre("results", "recordings"));
    EXPECT_THAT(
        completed("taut-merge", "r", folder_ / ""), UnorderedElementsAre("results", "recordings"));
}

TEST_F(TheCompletion, OffersTheWordsThatAValueCanBe)
{
    EXPECT_THAT(slam(R"(-v "")"), ElementsAre("ERROR", "WARN", "INFO", "DEBUG"));
    EXPECT_THAT(completed("taut-evaluate", "--align y", "."), ElementsAre("yaw"));
    EXPECT_THAT(slam(R"(--threads "")"), IsEmpty());
}

TEST_F(TheCompletion, OffersTheKeysOfTheMethod)
{
    EXPECT_THAT(slam("-s estimation.und"), ElementsAre("estimation.undistortion="));
    EXPECT_THAT(slam("-s output.occupancy.reso"), ElementsAre("output.occupancy.resolution="));
    EXPECT_THAT(slam("-s nonsense."), IsEmpty());
    EXPECT_THAT(completed("taut-merge", "a b --set map.ty", "."), ElementsAre("map.type="));
}

TEST_F(TheCompletion, OffersNoKeyThatCannotBeSet)
{
    const Words keys = slam(R"(-s "")");
    const std::string config = runProgram(TAUT_PROGRAMS "/taut-slam", "--show-config").output;
    std::istringstream lines(config);
    std::string settings;
    std::size_t values = 0;
    for (std::string line; std::getline(lines, line);)  // "    resolution: 0.2  # m, edge"
    {
        if (line.back() == ':') continue;
        ASSERT_LT(values, keys.size());
        const auto value = line.find(": ") + 2;
        settings += " -s " + keys[values++] + line.substr(value, line.find("  #") - value);
    }
    EXPECT_EQ(values, keys.size());
    EXPECT_GT(values, 100U);
    EXPECT_EQ(runProgram(TAUT_PROGRAMS "/taut-slam", "--show-config" + settings).output, config);
}
}  // namespace
