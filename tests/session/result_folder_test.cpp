#include "taut/session/ResultFolder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "temporary_folder.h"

using namespace taut;
using namespace taut::test;

namespace fs = std::filesystem;

namespace
{
void write(const std::string& path, const std::string& text)
{
    std::ofstream(path) << text;
}

std::string contentOf(const std::string& path)
{
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}
}  // namespace

TEST(AResultFolder, IsMadeAndMadeAnew)
{
    const TemporaryFolder folder;
    const std::string out = folder / "a/b";
    prepareResultFolder(out, false, {});
    write(out + "/trajectory.tum", "1");
    write(out + "/notes.txt", "mine");
    EXPECT_THROW(prepareResultFolder(out, false, {}), FolderInUse);
    EXPECT_EQ(contentOf(out + "/trajectory.tum"), "1");
    fs::create_directory(out + "/submaps");
    write(out + "/submaps/00000.tsm", "1");
    write(out + "/submaps/notes.ply", "mine");
    prepareResultFolder(out, true, {});
    EXPECT_FALSE(fs::exists(out + "/trajectory.tum"));
    EXPECT_FALSE(fs::exists(out + "/submaps/00000.tsm"));
    EXPECT_EQ(contentOf(out + "/notes.txt"), "mine");
    EXPECT_EQ(contentOf(out + "/submaps/notes.ply"), "mine");
}

TEST(AResultFolder, KeepsFilesThatTautDidNotWrite)
{
    const TemporaryFolder folder;
    for (const char* name : {"map.ply", "map.las", "config.yaml", "metrics.json"})
    {
        const std::string out = folder / (std::string(name) + ".d");
        fs::create_directory(out);
        write(out + "/" + name, "mine");
        for (const bool overwrite : {false, true})
            EXPECT_THROW(prepareResultFolder(out, overwrite, {}), FolderInUse) << name;
        EXPECT_EQ(contentOf(out + "/" + name), "mine");
    }
}

TEST(AResultFolder, NeverOverwritesWhatIsRead)
{
    const TemporaryFolder folder;
    const std::string out = folder / "out";
    prepareResultFolder(out, false, {});
    write(out + "/config.yaml", "method");
    EXPECT_THROW(prepareResultFolder(out, true, {"", folder / "out/config.yaml"}), FolderInUse);
    fs::create_symlink(out + "/config.yaml", folder / "link.yaml");
    EXPECT_THROW(prepareResultFolder(out, true, {folder / "link.yaml"}), FolderInUse);
    EXPECT_EQ(contentOf(out + "/config.yaml"), "method");
    prepareResultFolder(out, true, {folder / "absent"});
}

TEST(AResultFolder, DoesNotFollowLinks)
{
    const TemporaryFolder folder;
    const std::string out = folder / "out";
    prepareResultFolder(out, false, {});
    write(folder / "precious", "mine");
    fs::create_symlink(folder / "precious", out + "/map.ply");
    prepareResultFolder(out, true, {});
    EXPECT_FALSE(fs::exists(fs::symlink_status(out + "/map.ply")));
    EXPECT_EQ(contentOf(folder / "precious"), "mine");
}

TEST(AResultFolder, ThatIsAFileIsAnError)
{
    const TemporaryFolder folder;
    write(folder / "file", "");
    EXPECT_THROW(prepareResultFolder(folder / "file", true, {}), std::runtime_error);
}
