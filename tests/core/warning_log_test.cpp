#include "taut/core/WarningLog.h"

#include <gtest/gtest.h>

namespace taut
{
TEST(WarningLog, PassesOnTheFirstFewOfEachKindAndCountsTheRest)
{
    std::vector<std::string> passed;
    WarningLog log([&passed](const Warning& w) { passed.push_back(w.kind + w.text); }, 2);
    const auto sink = log.sink();
    for (int i = 0; i < 5; i++) sink({0, "a", std::to_string(i)});
    sink({7, "b", "0"});
    EXPECT_EQ(passed, (std::vector<std::string>{"a0", "a1", "b0"}));
    EXPECT_EQ(log.count("a"), 5u);
    EXPECT_EQ(log.count("b"), 1u);
    EXPECT_EQ(log.count("c"), 0u);
    ASSERT_EQ(log.kept().size(), 3u);
    EXPECT_EQ(log.kept()[2].t, 7);
    EXPECT_EQ(log.summaryOfRest(), "a: 5 times, of which the first 2 were reported\n");
}

TEST(WarningLog, WorksWithoutAnybodyListening)
{
    WarningLog log;
    log.add({0, "a", "text"});
    EXPECT_EQ(log.counts().at("a"), 1u);
    EXPECT_EQ(log.summaryOfRest(), "");
}
}  // namespace taut
