#include "taut/core/Yaml.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "taut/core/Config.h"
#include "temporary_folder.h"

using namespace taut;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace
{
std::string refusalOf(const std::string& text)
{
    try
    {
        parseYaml(text, "file.yaml");
    }
    catch (const ConfigError& e)
    {
        return e.what();
    }
    return "read";
}
}  // namespace

TEST(Yaml, ReadsValuesListsAndSectionsWithTheirLines)
{
    const YamlNode root = parseYaml("a: 1.5\nsection:\n  b: 'it''s'\n  list: [x, y]\nempty:\n");
    ASSERT_TRUE(root.isMap());
    EXPECT_EQ(root.find("a")->scalar, "1.5");
    const YamlNode* section = root.find("section");
    EXPECT_EQ(section->find("b")->scalar, "it's");
    EXPECT_EQ(section->find("b")->line, 3);
    ASSERT_EQ(section->find("list")->list.size(), 2u);
    EXPECT_EQ(section->find("list")->list[1].scalar, "y");
    EXPECT_TRUE(root.find("empty")->isNull());
    EXPECT_EQ(root.find("nothing"), nullptr);
}

TEST(Yaml, AnEmptyFileOrOneOfCommentsIsNothing)
{
    EXPECT_TRUE(parseYaml("").isNull());
    EXPECT_TRUE(parseYaml("# a comment\n\n").isNull());
    EXPECT_EQ(
        parseYaml("\xef\xbb\xbf"
                  "a: 1")
            .find("a")
            ->scalar,
        "1");
}

TEST(Yaml, OneBlankTooManyIsAnErrorInItsLine)
{
    EXPECT_THAT(refusalOf("imu:\n  gyro_noise: 1\n   accel_noise: 2\n"), HasSubstr("file.yaml:3"));
    EXPECT_THAT(refusalOf("a: 1\n b: 2\n"), HasSubstr("file.yaml:2"));
    EXPECT_NE(refusalOf("a:\n  b: 1\n c: 2\n"), "read");
    EXPECT_NE(refusalOf("a: [1, 2\nb: 3\n"), "read");
    EXPECT_THAT(refusalOf("x: 1\na: 'open\nb: 3\n"), HasSubstr("file.yaml:2: a quote"));
    EXPECT_THAT(refusalOf("a: \"open \\\"\nb: 3\n"), HasSubstr("never closed"));
    EXPECT_EQ(refusalOf("a: 'it''s'\nb: \"x\\\"y\"\nc: ''\n"), "read");
}

TEST(Yaml, BytesThatAreNotUtf8AreNamedWithTheirLine)
{
    EXPECT_THAT(
        refusalOf("a: 1\n# gr\xfc\xdf"
                  "e\nb: 2\n"),
        HasSubstr("file.yaml:2"));
    EXPECT_THAT(refusalOf("\xff\xfe"), HasSubstr("not UTF-8"));
    EXPECT_THAT(refusalOf("%PDF-1.4\n%\xe2\xe3\xcf\xd3\n"), HasSubstr("file.yaml:2"));
    EXPECT_THAT(refusalOf(std::string("a: 1\0\n", 6)), HasSubstr("control character"));
    EXPECT_THAT(refusalOf("a: \xc0\xaf"), HasSubstr("not UTF-8"));      // overlong
    EXPECT_THAT(refusalOf("a: \xed\xa0\x80"), HasSubstr("not UTF-8"));  // surrogate
    EXPECT_EQ(
        refusalOf("a: gr\xc3\xbc\xc3\x9f"
                  "e # \xe2\x82\xac \xf0\x9f\x98\x80\n"),
        "read");
}

TEST(Yaml, AKeyGivenTwiceNamesBothLines)
{
    EXPECT_THAT(
        refusalOf("a:\n  x: 1\nb: 2\na:\n  y: 3\n"),
        AllOf(HasSubstr("file.yaml:4"), HasSubstr("line 1"), HasSubstr("'a'")));
}

TEST(Yaml, DepthSizeAnchorsAndDocumentsAreBounded)
{
    EXPECT_NE(refusalOf(std::string(20'000, '[')), "read");
    std::string nested;
    for (int i = 0; i < 1000; i++) nested += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
    EXPECT_THAT(refusalOf(nested), HasSubstr("levels"));
    std::string dashes;
    for (int i = 0; i < 20'000; i++) dashes += "- ";
    EXPECT_THAT(refusalOf(dashes), HasSubstr("levels"));
    EXPECT_THAT(refusalOf("a: &x [1]\nb: *x\n"), HasSubstr("anchors"));
    EXPECT_THAT(refusalOf("a: 1\n---\nb: 2\n"), HasSubstr("second document"));
    EXPECT_THAT(refusalOf(std::string(1 << 21, 'a')), HasSubstr("bytes"));
    EXPECT_THAT(refusalOf("? [a, b]\n: 1\n"), HasSubstr("key was expected"));
}

TEST(Yaml, SettingsAreLaidOverATree)
{
    YamlNode root = parseYaml("a:\n  b: 1\nvalue: 3\n");
    root.section("a").set("b", "2");
    root.section("c.d").set("e", "5");
    EXPECT_EQ(root.find("a")->find("b")->scalar, "2");
    EXPECT_EQ(root.find("c")->find("d")->find("e")->scalar, "5");
    EXPECT_THROW(root.section("value.x"), ConfigError);
}

TEST(Yaml, ATextThatIsWrittenIsReadBackWhateverIsInIt)
{
    // The end of a line became a blank.
    for (const std::string text :
         {"two\nlines", "\n\n", "it's \"quoted\" \\ twice\t", " blanks ", "", "#1: [a, {b}]",
          "\xc3\xa4\r\n\x01", "\xef\xbb\xbf mark"})
    {
        SCOPED_TRACE(text);
        YamlNode node;
        node.section("a").set(text, text);
        const YamlNode back = parseYaml(yamlText(node));
        const YamlNode* section = back.find("a");
        ASSERT_NE(section, nullptr);
        ASSERT_NE(section->find(text), nullptr);
        EXPECT_EQ(section->find(text)->scalar, text);
        std::string value = text;
        ConfigSection config;
        config.key("name", value, "of a file");
        EXPECT_EQ(parseYaml(config.effective()).find("name")->scalar, text);
    }
}

TEST(Yaml, AnEmptyMapOrListStaysOne)
{
    for (const std::string text : {"{}\n", "'a': {}\n", "'a': []\n"})
        EXPECT_EQ(yamlText(parseYaml(text)), text);
}

TEST(YamlFile, WhatIsNoFileIsRefusedAtOnce)
{
    const taut::test::TemporaryFolder folder;
    const std::string fifo = folder / "pipe";
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    EXPECT_THROW(readYamlFile(fifo), ConfigError);
    EXPECT_THROW(readYamlFile(folder / ""), ConfigError);
    EXPECT_THROW(readYamlFile(folder / "absent"), ConfigError);
}

TEST(YamlFile, ErrorsNameIt)
{
    const taut::test::TemporaryFolder folder;
    std::ofstream(folder / "m.yaml") << "a: 1\na: 2\n";
    try
    {
        readYamlFile(folder / "m.yaml");
        FAIL();
    }
    catch (const ConfigError& e)
    {
        EXPECT_THAT(e.what(), HasSubstr((folder / "m.yaml") + ":2"));
    }
}
