/** docs/warnings.md: it has a row for every kind of warning that the code gives, and for no other.
 */
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace
{
using testing::IsEmpty;
using testing::IsSupersetOf;
using Kinds = std::set<std::string>;

std::string textOf(const fs::path& path)
{
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/** Adds what the first group of the expression matches, wherever it does. */
void addMatches(const std::string& text, const std::regex& expression, Kinds& kinds)
{
    for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it)
        kinds.insert((*it)[1]);
}

/** Kinds are texts such as "imu_gap" in statements that hand over a warning, or the cause of one.
 */
Kinds kindsInStatements(const std::string& source)
{
    static const std::regex hands_over(
        R"((\b(warn_?|sink|skip|report|isLater)|\bwarnings_?(\(\))?(\.add)?)\s*\(|\bcause = ")");
    static const std::regex kind(R"re("([a-z]+(?:_[a-z]+)+)")re");
    Kinds kinds;
    std::istringstream statements(source);
    for (std::string statement; std::getline(statements, statement, ';');)
        if (std::regex_search(statement, hands_over)) addMatches(statement, kind, kinds);
    return kinds;
}

Kinds kindsInCode()
{
    Kinds kinds;
    for (const char* folder : {"modules", "apps"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(TAUT_SOURCE) / folder))
        {
            const std::string extension = entry.path().extension().string();
            if (extension == ".cpp" || extension == ".h")
                kinds.merge(kindsInStatements(textOf(entry.path())));
        }
    return kinds;
}

/** Of the first cell of each row. */
Kinds kindsInPage()
{
    static const std::regex kind("`([a-z_]+)`");
    Kinds kinds;
    std::ifstream page(fs::path(TAUT_SOURCE) / "docs" / "warnings.md");
    for (std::string line; std::getline(page, line);)
        if (line.rfind("| `", 0) == 0) addMatches(line.substr(0, line.find('|', 1)), kind, kinds);
    return kinds;
}

Kinds without(const Kinds& all, const Kinds& known)
{
    Kinds rest;
    std::set_difference(
        all.begin(), all.end(), known.begin(), known.end(), std::inserter(rest, rest.end()));
    return rest;
}

TEST(DocumentationOfWarnings, FindsTheKindsOfEachWayToWarn)
{
    // Those of each way to write a warning: a search that finds none of them would prove nothing.
    EXPECT_THAT(
        kindsInCode(), IsSupersetOf(
                           {"imu_gap", "imu_duplicate", "imu_time", "pose_doubtful", "no_stamp",
                            "no_second_pass", "packets_lost", "rig_unused"}));
}

TEST(DocumentationOfWarnings, HasARowForEachKind)
{
    EXPECT_THAT(without(kindsInCode(), kindsInPage()), IsEmpty()) << "add rows to docs/warnings.md";
}

TEST(DocumentationOfWarnings, HasNoRowForAKindThatIsGone)
{
    EXPECT_THAT(without(kindsInPage(), kindsInCode()), IsEmpty()) << "of docs/warnings.md";
}
}  // namespace
