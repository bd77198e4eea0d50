/** taut-merge: joins the results of several runs of one place to one map.
 * Exit codes: 0 done, 1 failed, 2 bad usage, 3 done, but a run could not be joined. */
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "CommandLine.h"
#include "methodFile.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/session/Merge.h"
#include "taut/session/ResultFolder.h"
#include "taut/session/registerSession.h"

namespace fs = std::filesystem;

namespace
{
struct Options
{
    taut::MergeConfig merge;
    bool overwrite = false, quiet = false;
};

void checkFolders(const Options& o)
{
    if (o.merge.folders.size() < 2)
        throw taut::UsageError("two folders at least are wanted: the results of runs of taut-slam");
    for (std::size_t i = 0; i < o.merge.folders.size(); i++)
    {
        const fs::path folder = o.merge.folders[i];
        if (!fs::exists(folder / "graph.g2o"))
            throw std::runtime_error(
                "'" + folder.string() +
                "' holds no map: graph.g2o is missing, which taut-slam writes");
        if (fs::exists(o.merge.folder) && fs::equivalent(folder, o.merge.folder))
            throw taut::UsageError("-o is a folder that is read: the map would be overwritten");
        for (std::size_t k = 0; k < i; k++)
            if (fs::equivalent(folder, o.merge.folders[k]))
                throw taut::UsageError("'" + folder.string() + "' is given twice");
    }
}

/** False if only help was asked for. */
bool parse(int argc, char** argv, Options& o)
{
    TCLAP::CmdLine cmd(
        "taut-merge: joins the results of several runs of one place, each run for itself by "
        "taut-slam, to one graph and one map in the frame of the first. Exit codes: 0 done, 1 "
        "failed, 2 bad usage, 3 done, but a run could not be joined to the others.",
        ' ', TAUT_VERSION);
    TCLAP::UnlabeledMultiArg<std::string> folders(
        "folders", "Folders of results of taut-slam or taut-merge", true, "RUN/", cmd);
    TCLAP::ValueArg<std::string> output(
        "o", "output", "Folder for the results", true, "", "ALL/", cmd);
    TCLAP::ValueArg<std::string> config(
        "c", "config", "Method file (default: config/default.yaml)", false, "", "METHOD.yaml", cmd);
    TCLAP::MultiArg<std::string> set(
        "s", "set", "Override a key of the method file", false, "SECTION.KEY=VALUE", cmd);
    TCLAP::ValueArg<int> threads(
        "", "threads", "Threads (0: all processors); the result is the same", false, 0, "N", cmd);
    TCLAP::SwitchArg overwrite("w", "overwrite", "Write into a folder that has results", cmd);
    TCLAP::SwitchArg pictures("", "no-pictures", "Do not render snapshots", cmd);
    TCLAP::SwitchArg quiet("q", "quiet", "Errors only", cmd);
    if (!taut::parseCommandLine(cmd, argc, argv, {{"out/monday out/tuesday -o out/both"}, nullptr}))
        return false;
    o.merge.folders = folders.getValue();
    o.merge.folder = output.getValue();
    o.merge.pictures = !pictures.getValue();
    o.merge.threads = taut::threadsOf(threads.getValue());
    o.overwrite = overwrite.getValue();
    o.quiet = quiet.getValue();
    checkFolders(o);
    taut::ConfigSection root =
        taut::readMethodFile(taut::findMethodFile(config.getValue()), set.getValue());
    o.merge.method = taut::Method::read(root, {});
    return true;
}

int run(int argc, char** argv)
{
    taut::registerSession();
    taut::registerRenderers();
    Options o;
    if (!parse(argc, argv, o)) return 0;
    try
    {
        taut::prepareResultFolder(o.merge.folder, o.overwrite, {});
    }
    catch (const taut::FolderInUse& e)
    {
        throw taut::UsageError(e.what());
    }
    taut::WarningLog warnings(
        [&](const taut::Warning& w)
        {
            if (!o.quiet)
                std::fprintf(stderr, "warning [%s]: %s\n", w.kind.c_str(), w.text.c_str());
        });
    const taut::MergeOutcome outcome = taut::mergeRuns(o.merge, warnings);
    if (!o.quiet)
        std::printf(
            "%zu runs joined by %zu loops: %zu submaps, %zu map points\nresults in %s: "
            "trajectory_N.tum, map.ply, map.ot, map.bt, graph.g2o, submaps/, metrics.json\n",
            outcome.runs, outcome.loops, outcome.submaps, outcome.map_points,
            o.merge.folder.c_str());
    if (outcome.pictures_failed) return 1;
    return outcome.apart.empty() ? 0 : 3;
}
}  // namespace

int main(int argc, char** argv)
{
    return taut::runProgram("taut-merge", [&] { return run(argc, argv); });
}
