#include "taut/map/KeyTable.h"

#include <gtest/gtest.h>

#include <map>

using namespace taut;

namespace
{
/** Keys as windows have them: close to each other, in multiples of a step. */
std::uint64_t keyOf(std::uint64_t i)
{
    return i % 23 * 8 | i / 23 % 19 * 8 << 16 | i / 437 * 8 << 32;
}
}  // namespace

TEST(KeyTable, AnEmptyTableHasNoKey)
{
    const KeyTable table;
    EXPECT_EQ(table.size(), 0u);
    EXPECT_EQ(table.find(0), KeyTable::kNone);
    EXPECT_EQ(table.find(7), KeyTable::kNone);
}

TEST(KeyTable, GivesTheNumberOfEachKeyAndOfNoOther)
{
    KeyTable table;
    for (std::uint32_t i = 0; i < 10'000; i += 2) table.insert(keyOf(i), i);
    EXPECT_EQ(table.size(), 5000u);
    for (std::uint32_t i = 0; i < 10'000; i++)
        ASSERT_EQ(table.find(keyOf(i)), i % 2 == 0 ? i : KeyTable::kNone);
}

TEST(KeyTable, ErasesWhatIsAskedForAndKeepsTheRest)
{
    KeyTable table;
    for (std::uint32_t i = 0; i < 3000; i++) table.insert(keyOf(i), i);
    std::map<std::uint64_t, std::uint32_t> asked;
    table.eraseIf(
        [&](std::uint64_t key, std::uint32_t number)
        {
            asked.emplace(key, number);
            return number % 3 == 0;
        });
    EXPECT_EQ(asked.size(), 3000u);
    EXPECT_EQ(table.size(), 2000u);
    for (std::uint32_t i = 0; i < 3000; i++)
    {
        ASSERT_EQ(asked.at(keyOf(i)), i);
        ASSERT_EQ(table.find(keyOf(i)), i % 3 == 0 ? KeyTable::kNone : i);
    }
}

TEST(KeyTable, TakesAKeyAgainThatWasErased)
{
    KeyTable table;
    table.insert(5, 1);
    table.eraseIf([](std::uint64_t, std::uint32_t) { return true; });
    EXPECT_EQ(table.find(5), KeyTable::kNone);
    table.insert(5, 2);
    EXPECT_EQ(table.find(5), 2u);
    EXPECT_EQ(table.size(), 1u);
}
