#include "taut/core/Config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

using namespace taut;
using ::testing::HasSubstr;

namespace
{
ConfigSection parse(const std::string& text)
{
    return ConfigSection(parseYaml(text));
}

template <class F>
std::string messageOf(F f)
{
    try
    {
        f();
    }
    catch (const ConfigError& e)
    {
        return e.what();
    }
    return "no error";
}
}  // namespace

TEST(Config, ReadsGivenValuesAndKeepsDefaults)
{
    auto c = parse("a: 2.5\nmap:\n  n: 7\n  on: false\n");
    double a = 1, b = 3;
    int n = 0;
    bool on = true;
    c.key("a", a, kPositive, "m");
    c.key("b", b, kPositive, "m");
    c.section("map").key("n", n, kPositive, "count");
    c.section("map").key("on", on, "switch");
    EXPECT_NO_THROW(c.rejectUnknown());
    EXPECT_EQ(a, 2.5);
    EXPECT_EQ(b, 3);
    EXPECT_EQ(n, 7);
    EXPECT_FALSE(on);
}

TEST(Config, NamesTheUnknownKeyWithItsPath)
{
    auto c = parse("map:\n  voxel_sise: 7\n");
    double v = 1;
    c.section("map").key("voxel_size", v, kPositive, "m");
    EXPECT_THAT(messageOf([&] { c.rejectUnknown(); }), HasSubstr("'map.voxel_sise'"));
}

TEST(Config, RefusesValuesOutOfRangeAndNotNumbers)
{
    double v = 1;
    int n = 1;
    bool b = true;
    EXPECT_THAT(
        messageOf([&] { parse("v: -1").key("v", v, kPositive, "m"); }), HasSubstr("'v' is -1"));
    EXPECT_THAT(messageOf([&] { parse("v: .nan").key("v", v, kPositive, "m"); }), HasSubstr("'v'"));
    EXPECT_THAT(
        messageOf([&] { parse("v: 3 m").key("v", v, kPositive, "m"); }), HasSubstr("not a number"));
    EXPECT_THAT(
        messageOf([&] { parse("n: 1.5").key("n", n, kPositive, ""); }), HasSubstr("whole number"));
    EXPECT_THAT(messageOf([&] { parse("b: maybe").key("b", b, ""); }), HasSubstr("neither true"));
    EXPECT_THAT(messageOf([&] { parse("s: 3").section("s"); }), HasSubstr("'s' is not a map"));
}

TEST(Config, ListsTheChoices)
{
    enum class E
    {
        A,
        B
    } e = E::A;
    EXPECT_THAT(
        messageOf(
            [&] {
                parse("e: c").choice<E>("e", e, {{"a", E::A}, {"b", E::B}}, "");
            }),
        HasSubstr("choose from: a b"));
    parse("e: b").choice<E>("e", e, {{"a", E::A}, {"b", E::B}}, "");
    EXPECT_EQ(e, E::B);
}

TEST(Config, EveryNumberReadsBackToTheSameBits)
{
    const Range any{0, std::numeric_limits<double>::max()};
    for (const double v : {0.1 + 0.2, 1.0 / 3, 2e-4, 1e-310, 1.7976931348623157e308, 123456789.125})
    {
        double a = v, b = 0;
        ConfigSection first;
        first.key("a", a, any, "");
        auto second = parse(first.effective());
        second.key("a", b, any, "");
        EXPECT_EQ(b, v);
    }
}

TEST(Config, AnEmptySectionIsNothingAndAListIsNoValue)
{
    double v = 1;
    auto empty = parse("s:\n");
    empty.section("s").key("v", v, kPositive, "m");
    EXPECT_EQ(v, 1);
    EXPECT_THAT(
        messageOf([&] { parse("\nv: [1, 2]").key("v", v, kPositive, "m"); }),
        testing::AllOf(HasSubstr("line 2"), HasSubstr("'v' is a list")));
    EXPECT_THAT(
        messageOf([&] { parse("v: {a: 1}").key("v", v, kPositive, "m"); }), HasSubstr("section"));
    EXPECT_THAT(
        messageOf([&] { parse("v:").key("v", v, kPositive, "m"); }), HasSubstr("has no value"));
    EXPECT_THAT(messageOf([&] { parse("a: 1\nx: 2").rejectUnknown(); }), HasSubstr("line 1"));
}

TEST(Config, EffectiveTextReadsBackTheSame)
{
    auto declare = [](ConfigSection& c)
    {
        double a = 0.1;
        std::string s = "it's";
        c.key("a", a, kPositive, "m");
        c.section("sub").key("s", s, "text");
        return std::to_string(a) + s;
    };
    auto first = parse("a: 0.25");
    const auto values = declare(first);
    auto second = parse(first.effective());
    EXPECT_EQ(declare(second), values);
    EXPECT_EQ(second.effective(), first.effective());
}
