#include <gmock/gmock.h>

#include <fstream>

#include "taut/files/PcdFile.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
using testing::ElementsAre;
using testing::HasSubstr;

class APcdFile : public testing::Test
{
 protected:
    void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }

    std::string refusal() const
    {
        try
        {
            PcdReader reader(path_);
            std::vector<double> row;
            while (reader.next(row))
            {
            }
        }
        catch (const std::runtime_error& e)
        {
            return e.what();
        }
        return "";
    }

    static std::string header(const std::string& data, int points = 2)
    {
        return "VERSION 0.7\nFIELDS x n t\nSIZE 4 2 8\nTYPE F I F\nCOUNT 1 2 1\nPOINTS " +
               std::to_string(points) + "\nDATA " + data + "\n";
    }

    const TemporaryFolder folder_;
    const std::string path_ = folder_ / "a.pcd";
};

TEST_F(APcdFile, GivesItsColumnsAndPoints)
{
    const float x = 1.5f;
    const std::int16_t n[] = {-3, 4};
    const double t = 1e9 + 0.25;
    std::string point(reinterpret_cast<const char*>(&x), 4);
    point.append(reinterpret_cast<const char*>(n), 4);
    point.append(reinterpret_cast<const char*>(&t), 8);
    for (const bool binary : {true, false})
    {
        write(
            binary ? header("binary") + point + point
                   : header("ascii") + "1.5 -3 4 1000000000.25\n1.5\t-3 4 1000000000.25\n");
        PcdReader reader(path_);
        EXPECT_THAT(reader.columns(), ElementsAre("x", "n", "n[1]", "t"));
        EXPECT_EQ(reader.size(), 2U);
        std::vector<double> row;
        for (int i = 0; i < 2; i++)
        {
            ASSERT_TRUE(reader.next(row));
            EXPECT_THAT(row, ElementsAre(1.5, -3, 4, t));
        }
        EXPECT_FALSE(reader.next(row));
    }
}

TEST_F(APcdFile, NamesWhatIsWrongInIt)
{
    EXPECT_THAT(refusal(), HasSubstr("cannot be opened"));
    write("ply\n");
    EXPECT_THAT(refusal(), HasSubstr("no header that ends with 'DATA'"));
    write(header("binary") + "only 20 bytes here..");
    EXPECT_THAT(refusal(), HasSubstr("ends after 1 of 2 points"));
    write(header("ascii") + "1 2 3 4\n");
    EXPECT_THAT(refusal(), HasSubstr("ends after 1 of 2 points"));
    write(header("ascii") + "1 2 3\n1 2 3 4\n");
    EXPECT_THAT(refusal(), HasSubstr("point 0 is not a row of numbers"));
    write(header("binary_compressed"));
    EXPECT_THAT(refusal(), HasSubstr("save it as binary or ascii"));
    write("FIELDS x\nSIZE 3\nTYPE F\nPOINTS 1\nDATA ascii\n1\n");
    EXPECT_THAT(refusal(), HasSubstr("type F and size 3"));
    write("FIELDS x\nSIZE 4 4\nTYPE F\nPOINTS 1\nDATA ascii\n1\n");
    EXPECT_THAT(refusal(), HasSubstr("differ in length"));
    write("FIELDS x\nSIZE 4\nTYPE F\nPOINTS many\nDATA ascii\n1\n");
    EXPECT_THAT(refusal(), HasSubstr("'many' in the header is no number"));
}
}  // namespace
}  // namespace taut::test
