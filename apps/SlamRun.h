#pragma once

#include <memory>
#include <string>
#include <vector>

#include "PoseStream.h"
#include "Progress.h"
#include "SlamArguments.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/session/Session.h"

namespace taut
{
/** Loads shared libraries that register classes. Throws ConfigError that names the one that cannot
 * be loaded. */
void loadPlugins(const std::vector<std::string>& plugins);

/** What the programs that estimate have in common: settings, warnings, progress, the last lines. */
class SlamRun
{
 public:
    /** Reads the files that the options name, which must outlive it. Throws what these readers
     * throw. */
    SlamRun(const SlamOptions& options, PoseStream::WhereNobodyReads stream);

    SessionConfig& session() { return session_; }
    WarningLog& warnings() { return warnings_; }
    Progress& progress() { return progress_; }

    /** Of the log at `path`, with the sensors and the rig of the options. */
    RawlogConfig rawlog(const std::string& path) const;

    /** Makes the folder ready; `inputs` are not written over, nor are results put into a folder
     * among them. Throws UsageError. */
    void makeFolder(const std::vector<std::string>& inputs) const;

    /** The events of the session go here. */
    void take(const Event& event);

    /** To be called in the second pass. */
    void showSecondPass(double share) { second_pass_.update(share); }

    /** A line for the user, if he wants to hear of progress. */
    void tell(const std::string& line);

    /** Prints how it ended; the exit code. Throws std::runtime_error if it failed. `findings`:
     * about the recording, if it had to be imported. */
    int end(const SessionOutcome& outcome, const std::vector<std::string>& findings = {});

 private:
    void print(const Warning& warning);
    void printResults(
        const SessionOutcome& outcome, const std::vector<std::string>& findings) const;

    const SlamOptions& options_;
    Rig rig_;
    SessionConfig session_;
    Progress progress_, second_pass_;
    WarningLog warnings_;
    std::unique_ptr<PoseStream> stream_;
};
}  // namespace taut
