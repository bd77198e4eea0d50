#include "taut/factors/RobustKernel.h"

#include <gtest/gtest.h>

#include <array>
#include <ostream>

namespace taut
{
void PrintTo(Kernel kernel, std::ostream* out)
{
    constexpr std::array<const char*, 4> kNames{"none", "huber", "cauchy", "geman_mcclure"};
    *out << kNames.at(static_cast<std::size_t>(kernel));
}
}  // namespace taut

using namespace taut;

namespace
{
class AnyKernel : public ::testing::TestWithParam<Kernel>
{
 protected:
    RobustKernel kernel{GetParam(), 2.5};
};
}  // namespace

TEST_P(AnyKernel, WeightIsTheDerivativeOfRho)
{
    for (const double e2 : {0.0, 0.01, 1.0, 6.0, 6.5, 40.0, 1e4})
    {
        const double h = 1e-6 * (1 + e2);
        const double slope =
            e2 > 0 ? (kernel.rho(e2 + h) - kernel.rho(e2 - h)) / (2 * h) : kernel.rho(h) / h;
        EXPECT_NEAR(kernel.weight(e2), slope, 1e-5 * (1 + slope));
    }
}

TEST_P(AnyKernel, SmallResidualsAreSquaresAndLargeOnesCountNoMore)
{
    EXPECT_EQ(kernel.rho(0), 0);
    EXPECT_NEAR(kernel.rho(1e-6), 1e-6, 1e-12);
    double weight = 1;
    for (double e2 = 0; e2 < 1e6; e2 = 2 * e2 + 0.1)
    {
        EXPECT_LE(kernel.weight(e2), weight);
        EXPECT_GT(kernel.weight(e2), 0);
        EXPECT_LE(kernel.rho(e2), e2);
        weight = kernel.weight(e2);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Of, AnyKernel,
    ::testing::Values(Kernel::None, Kernel::Huber, Kernel::Cauchy, Kernel::GemanMcClure),
    ::testing::PrintToStringParamName());

TEST(RobustKernel, AnOutlierOfACauchyKernelHardlyPulls)
{
    const RobustKernel cauchy{Kernel::Cauchy, 3}, huber{Kernel::Huber, 3};
    EXPECT_LT(cauchy.weight(1e4), 1e-3);
    EXPECT_NEAR(huber.weight(1e4) * 100, 3, 1e-9);  // constant pull: scale
}

TEST(RobustKernel, ManyOutliersOfAGemanMcClureKernelPullLessThanOneGoodMatch)
{
    const RobustKernel kernel{Kernel::GemanMcClure, 3};
    const double outlier = 24;  // sigmas: a stair's step, seen by a window that is thin
    EXPECT_LT(100 * kernel.weight(outlier * outlier) * outlier, kernel.weight(1));
}

TEST(RobustKernel, ReadsItsConfiguration)
{
    ConfigSection section(parseYaml("{kernel: huber, kernel_scale: 1.5}"), "lidar");
    RobustKernel kernel;
    kernel.declare(section);
    EXPECT_EQ(kernel.kind, Kernel::Huber);
    EXPECT_EQ(kernel.scale, 1.5);
    ConfigSection wrong(parseYaml("{kernel: gauss}"), "lidar");
    EXPECT_THROW(kernel.declare(wrong), ConfigError);
}
