#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>

namespace taut::test
{
/** Central differences of f at zero, for a perturbation of n entries. */
inline Eigen::MatrixXd numericJacobian(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f, int n, double step = 1e-5)
{
    const Eigen::VectorXd f0 = f(Eigen::VectorXd::Zero(n));
    Eigen::MatrixXd J(f0.size(), n);
    for (int i = 0; i < n; i++)
    {
        Eigen::VectorXd d = Eigen::VectorXd::Zero(n);
        d[i] = step;
        J.col(i) = (f(d) - f(-d)) / (2 * step);
    }
    return J;
}

/** Reproducible random vectors. */
class Random
{
 public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double uniform(double lo, double hi)
    {
        return std::uniform_real_distribution<double>(lo, hi)(engine_);
    }
    double normal() { return std::normal_distribution<double>()(engine_); }
    Eigen::Vector3d vector(double sigma)
    {
        Eigen::Vector3d v;
        for (int i = 0; i < 3; i++) v[i] = sigma * normal();
        return v;
    }

 private:
    std::mt19937_64 engine_;
};
}  // namespace taut::test
