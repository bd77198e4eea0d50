#include "taut/session/LoadControl.h"

#include <gtest/gtest.h>

#include <cmath>

#include "taut/session/LiveWatch.h"

using namespace taut;

namespace
{
constexpr double kInterval = 0.05;

/** A machine that needs `fixed` + `by_share` * share [s] for a scan, and falls behind if that is
 * more than there is time for. */
struct Machine
{
    double fixed = 0.005, by_share = 0.02;
    double late = 0.01;  // [s]
    LoadControl control;
    int changes = 0;

    double work() const { return fixed + by_share * control.share(); }

    void run(int scans)
    {
        for (int i = 0; i < scans; i++)
        {
            late = std::max(0.01, late + work() - kInterval);
            changes += control.add(kInterval, work(), late) ? 1 : 0;
        }
    }
};
}  // namespace

TEST(LoadControl, LeavesAFastMachineAlone)
{
    Machine machine;
    machine.run(1000);
    EXPECT_EQ(machine.control.share(), 1);
    EXPECT_EQ(machine.changes, 0);
    EXPECT_NEAR(machine.control.load(), 0.5, 1e-9);
}

TEST(LoadControl, DoesLessBeforeASlowMachineFallsBehind)
{
    Machine machine;
    machine.run(100);
    machine.by_share = 0.055;  // 20 % more than there is time for
    machine.run(30);
    EXPECT_LT(machine.control.share(), 1);
    EXPECT_LT(machine.late, 4 * kInterval);
    machine.run(300);
    EXPECT_EQ(machine.late, 0.01);
    EXPECT_LT(machine.work(), 0.9 * kInterval);
}

TEST(LoadControl, DoesNotSwingBetweenTwoShares)
{
    Machine machine;
    machine.by_share = 0.047;  // all is too much, and the share below that leaves no room to rise
    machine.run(4000);         // more than three minutes
    EXPECT_EQ(machine.control.share(), 0.7);
    EXPECT_EQ(machine.changes, 1);
}

TEST(LoadControl, DoesAllAgainWhenTheMachineIsFree)
{
    Machine machine;
    machine.by_share = 0.2;
    machine.run(200);
    EXPECT_EQ(machine.control.share(), 0.25);
    machine.by_share = 0.02;
    machine.run(90);  // of 5 s of calm
    EXPECT_EQ(machine.control.share(), 0.25);
    machine.run(4 * 120);
    EXPECT_EQ(machine.control.share(), 1);
}

// The work grows with the share more than by proportion: what is tried again and again fails.
TEST(LoadControl, TriesAStepThatFailedLessAndLessOften)
{
    LoadControl control;
    int failed = 0;
    for (int i = 0; i < 20 * 400; i++)  // 400 s
    {
        const double before = control.share();
        control.add(kInterval, control.share() == 1 ? 0.06 : 0.02, 0.01);
        failed += control.share() < before ? 1 : 0;
    }
    EXPECT_GE(failed, 4);
    EXPECT_LE(failed, 9);  // every 5 s it would be some 70
}

TEST(LoadControl, DoesLessWherePosesGetLaterAndLater)
{
    LoadControl control;
    for (int i = 0; i < 30; i++) control.add(kInterval, 0.01, 0.1 + 0.02 * i);
    EXPECT_LT(control.share(), 1);
}

TEST(LoadControl, DoesNotDoLessWhileALateStartIsCaughtUp)
{
    LoadControl control;
    for (int i = 0; i < 60; i++) control.add(kInterval, 0.01, std::max(0.01, 2 - 0.04 * i));
    EXPECT_EQ(control.share(), 1);
}

TEST(LoadControl, IsNotLedAstrayByImpossibleNumbers)
{
    LoadControl control;
    for (const double bad : std::initializer_list<double>{0, -1, std::nan(""), HUGE_VAL})
        EXPECT_FALSE(control.add(bad, 0.01, 0.01));
    EXPECT_FALSE(control.add(kInterval, std::nan(""), 0.01));
    control.add(kInterval, 0.01, 0.01);
    EXPECT_NEAR(control.load(), 0.2, 1e-9);
}

TEST(LiveWatch, TellsHowLatePosesWere)
{
    double age = 0;
    LiveWatch watch({[&](const Scan&) { return std::optional(age); }, true});
    Scan scan;
    for (int i = 0; i < 110; i++)
    {
        scan.end += 50'000'000;
        // Ten that are late at the start; later one that is late, and one that is very late.
        age = i < 10 ? 1 - 0.1 * i : i == 50 ? 0.06 : i == 60 ? 0.3 : 0.02;
        EXPECT_FALSE(watch.add(scan, 0.005));
    }
    const LiveSummary summary = watch.summary();
    EXPECT_EQ(summary.scans, 100u);
    EXPECT_EQ(summary.late, 2u);
    EXPECT_NEAR(summary.median, 0.02, 1e-6);
    EXPECT_NEAR(summary.percentile_99, 0.06, 1e-6);
    EXPECT_NEAR(summary.worst, 0.3, 1e-6);
    EXPECT_NEAR(summary.caught_up, 0.5, 1e-6);
    EXPECT_NEAR(summary.load, 0.1, 1e-6);
    EXPECT_TRUE(summary.reduced.empty());
}

TEST(LiveWatch, TellsTheStretchesInWhichItDidLess)
{
    LiveWatch watch({{}, true});
    Scan scan;
    Time changed = 0;
    for (int i = 0; i < 20; i++)
    {
        scan.end += 50'000'000;
        if (watch.add(scan, 0.06)) changed = scan.end;
    }
    const LiveSummary summary = watch.summary();
    ASSERT_EQ(summary.reduced.size(), 1u);
    EXPECT_EQ(summary.reduced[0].from, changed);
    EXPECT_EQ(summary.reduced[0].to, scan.end);
    EXPECT_EQ(summary.reduced[0].share, 0.7);
    EXPECT_EQ(summary.scans, 0u);  // ages are not known
    LiveWatch never({{}, false});
    for (int i = 0; i < 50; i++)
    {
        scan.end += 50'000'000;
        EXPECT_FALSE(never.add(scan, 0.06));
    }
}
