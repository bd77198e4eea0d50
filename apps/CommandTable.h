#pragma once

#include <string>
#include <vector>

namespace taut
{
/** An option of a program, or an argument that stands without a name. */
struct TableEntry
{
    std::string flag;         //!< its letter; empty: none
    std::string name;         //!< without dashes; neither this nor a letter: an argument
    std::string value;        //!< what stands for the value, as "LOG.rawlog"; empty: a switch
    std::string description;  //!< one sentence without a full stop
    bool required = false;
    bool repeated = false;  //!< may be given several times

    bool isArgument() const { return flag.empty() && name.empty(); }
    /** The ways to write the option, as "-i" and "--input"; none for an argument. */
    std::vector<std::string> spellings() const;
};

/** All that a program says of its use. --help, the manual page and the completion are made of it,
 * so that they do not differ. */
struct CommandTable
{
    std::string program, version;
    std::string summary;                  //!< the first sentence, without a full stop
    std::string details;                  //!< further sentences; may be empty
    std::vector<std::string> exit_codes;  //!< each with its meaning, as "0 done"
    std::vector<std::string> synopses;    //!< arguments without the program's name
    std::vector<std::string> examples;    //!< the same
    std::vector<TableEntry> entries;      //!< in the order in which they are told
};

/** Takes a message apart, "PROGRAM: Summary. Details. Exit codes: 0 done, 1 failed.", where all but
 * the summary may be absent. */
void describe(const std::string& message, CommandTable& table);

/** The text of --help, in lines of at most 90 letters. */
std::string helpText(const CommandTable& table);

/** The manual page of section 1, in the "man" macros of groff. */
std::string manualPage(const CommandTable& table);

/** A script that makes bash complete the options of the program, and their values. */
std::string bashCompletion(const CommandTable& table);
}  // namespace taut
