#include <gmock/gmock.h>

#include <fstream>

#include "taut/importing/openImportSource.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
std::string refusal(const std::string& path)
{
    try
    {
        openImportSource(path);
    }
    catch (const std::runtime_error& e)
    {
        return e.what();
    }
    return "opened";
}

TEST(ARecording, ThatIsNotThereOrEmptyIsNamed)
{
    const TemporaryFolder folder;
    std::ofstream(folder / "empty");
    EXPECT_THAT(refusal(folder / "none"), testing::HasSubstr("none' is not there"));
    EXPECT_THAT(refusal(folder / "empty"), testing::HasSubstr("empty' is empty"));
}

TEST(ARecording, OfNoKnownFormatIsNamed)
{
    const TemporaryFolder folder;
    std::ofstream(folder / "text.txt") << "hello";
    EXPECT_THAT(refusal(folder / "text.txt"), testing::HasSubstr("text.txt' is no recording"));
    EXPECT_THAT(refusal(folder / "."), testing::HasSubstr("is no recording"));
}
}  // namespace
}  // namespace taut::test
