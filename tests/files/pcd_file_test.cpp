#include <gmock/gmock.h>
#include <lzf.h>

#include <cmath>
#include <fstream>
#include <limits>

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

    /** What stands behind the header of a compressed file. `packed`, `whole`: the sizes it states.
     */
    static std::string sized(const std::string& bytes, std::size_t packed, std::size_t whole)
    {
        const auto number = [](std::size_t n)
        {
            const auto word = static_cast<std::uint32_t>(n);
            return std::string(reinterpret_cast<const char*>(&word), sizeof word);
        };
        return number(packed) + number(whole) + bytes;
    }

    static std::string packed(const std::string& data)
    {
        std::string bytes(2 * data.size() + 100, '\0');
        bytes.resize(lzf_compress(
            data.data(), static_cast<unsigned>(data.size()), bytes.data(),
            static_cast<unsigned>(bytes.size())));
        return bytes;
    }

    template <class T>
    static void put(std::string& to, T value)
    {
        to.append(reinterpret_cast<const char*>(&value), sizeof value);
    }

    /** The fields of header(), each of all points. */
    static std::string fieldByField(int points)
    {
        std::string data;
        for (int i = 0; i < points; i++) put(data, 0.5f * static_cast<float>(i));
        for (int i = 0; i < points; i++)
        {
            put(data, static_cast<std::int16_t>(-i));
            put(data, static_cast<std::int16_t>(i % 7));
        }
        for (int i = 0; i < points; i++) put(data, 1e9 + 0.25 * i);
        return data;
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
    write(header("packed"));
    EXPECT_THAT(refusal(), HasSubstr("'packed' is not supported: save it as binary or ascii"));
    write("FIELDS x\nSIZE 3\nTYPE F\nPOINTS 1\nDATA ascii\n1\n");
    EXPECT_THAT(refusal(), HasSubstr("type F and size 3"));
    write("FIELDS x\nSIZE 4 4\nTYPE F\nPOINTS 1\nDATA ascii\n1\n");
    EXPECT_THAT(refusal(), HasSubstr("differ in length"));
    write("FIELDS x\nSIZE 4\nTYPE F\nPOINTS many\nDATA ascii\n1\n");
    EXPECT_THAT(refusal(), HasSubstr("'many' in the header is no number"));
}

TEST_F(APcdFile, ThatIsCompressedGivesItsPoints)
{
    const int n = 1000;
    const std::string data = fieldByField(n), bytes = packed(data);
    ASSERT_LT(bytes.size(), data.size());
    write(header("binary_compressed", n) + sized(bytes, bytes.size(), data.size()));
    PcdReader reader(path_);
    EXPECT_THAT(reader.columns(), ElementsAre("x", "n", "n[1]", "t"));
    ASSERT_EQ(reader.size(), std::size_t{n});
    std::vector<double> row;
    for (int i = 0; i < n; i++)
    {
        ASSERT_TRUE(reader.next(row));
        ASSERT_THAT(row, ElementsAre(0.5 * i, -i, i % 7, 1e9 + 0.25 * i));
    }
    EXPECT_FALSE(reader.next(row));
}

TEST_F(APcdFile, ThatIsCompressedAndOrganisedKeepsTheRowsOfNaN)
{
    std::string data;
    for (const float x : {1.f, std::numeric_limits<float>::quiet_NaN(), 3.f, 4.f}) put(data, x);
    data += "\5\6\7\10";
    const std::string bytes = packed(data);
    write(
        "FIELDS x y\nSIZE 4 1\nTYPE F U\nCOUNT 1 1\nWIDTH 2\nHEIGHT 2\nPOINTS 4\n"
        "DATA binary_compressed\n" +
        sized(bytes, bytes.size(), data.size()) + "more");
    PcdReader reader(path_);
    std::vector<double> row;
    std::vector<double> y;
    std::size_t holes = 0;
    while (reader.next(row))
    {
        if (std::isnan(row[0])) holes++;
        y.push_back(row[1]);
    }
    EXPECT_EQ(holes, 1U);
    EXPECT_THAT(y, ElementsAre(5, 6, 7, 8));
}

TEST_F(APcdFile, ThatIsCompressedAndHasNoPointsIsRead)
{
    for (const std::string& rest : {std::string(), sized("", 0, 0)})
    {
        write(header("binary_compressed", 0) + rest);
        EXPECT_EQ(refusal(), "");
    }
}

TEST_F(APcdFile, ThatIsCompressedNamesWhatIsWrongInIt)
{
    const int n = 100;
    const std::string data = fieldByField(n), bytes = packed(data);
    const std::string begin = header("binary_compressed", n);
    const std::size_t most = std::numeric_limits<std::uint32_t>::max();
    write(begin);
    EXPECT_THAT(refusal(), HasSubstr("ends before the sizes"));
    write(begin + "1234567");
    EXPECT_THAT(refusal(), HasSubstr("ends before the sizes"));
    write(begin + sized(bytes.substr(0, 50), bytes.size(), data.size()));
    EXPECT_THAT(refusal(), HasSubstr("ends after 50 of " + std::to_string(bytes.size())));
    write(begin + sized(bytes, most, data.size()));
    EXPECT_THAT(refusal(), HasSubstr("of 4294967295 bytes of compressed data"));
    for (const std::size_t whole : {std::size_t{0}, data.size() - 1, data.size() + 16, most})
    {
        write(begin + sized(bytes, bytes.size(), whole));
        EXPECT_THAT(refusal(), HasSubstr("but 100 points of 16 bytes each")) << whole;
    }
    // The header and the size agree, but so few bytes never give so many: nothing is reserved.
    write(
        header("binary_compressed", 268'000'000) +
        sized(bytes, bytes.size(), std::size_t{268'000'000} * 16));
    EXPECT_THAT(refusal(), HasSubstr("compressed bytes cannot hold"));
    // 2^60 points of 16 bytes are 2^64 bytes, which is 0 to a program that multiplies.
    std::string huge = header("binary_compressed");
    huge.replace(huge.find("POINTS 2"), 8, "POINTS 1152921504606846976");
    write(huge + sized(bytes, bytes.size(), 0));
    EXPECT_THAT(refusal(), HasSubstr("1152921504606846976 points"));
}

TEST_F(APcdFile, ThatIsCompressedAndDamagedIsRefused)
{
    const int n = 100;
    const std::string data = fieldByField(n), bytes = packed(data);
    const std::string begin = header("binary_compressed", n);
    std::string damaged = bytes;
    damaged.front() = '\xff';  // a reference to what is before the first byte
    write(begin + sized(damaged, damaged.size(), data.size()));
    EXPECT_THAT(refusal(), HasSubstr("the compressed data are damaged"));
    const std::string less = packed(data.substr(0, data.size() - 8));
    write(begin + sized(less, less.size(), data.size()));
    EXPECT_THAT(refusal(), HasSubstr("the compressed data are damaged"));
    const std::string more = packed(data + "12345678");
    write(begin + sized(more, more.size(), data.size()));
    EXPECT_THAT(refusal(), HasSubstr("the compressed data are damaged"));
}
}  // namespace
}  // namespace taut::test
