#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "numeric.h"
#include "taut/core/Geometry.h"
#include "taut/core/Solver.h"

namespace taut::test
{
/** Pose of a sensor from noisy positions and noisy distances of known points: rotation and
 * translation together, curved, with residuals that do not vanish. Unknowns: p, theta (right). */
class SensorPoseProblem : public LeastSquaresProblem
{
 public:
    explicit SensorPoseProblem(unsigned seed)
    {
        Random random(seed);
        for (int i = 0; i < 12; i++)
        {
            Sight s;
            s.in_sensor = random.vector(4);
            s.position = truth * s.in_sensor + random.vector(kSigma);
            s.beacon = random.vector(6);
            s.distance = (truth.p - s.beacon).norm() + kSigma * random.normal();
            sights_.push_back(s);
        }
    }

    int dimension() const override { return 6; }

    double linearize(ProblemMatrix& hessian, ProblemVector& gradient) override
    {
        hessian.setZero(6, 6);
        gradient.setZero(6);
        for (const Sight& s : sights_)
        {
            Eigen::Matrix<double, 4, 6> J;
            const Vector3d to = estimate.p - s.beacon;
            J << Matrix3d::Identity(), -estimate.R * hat(s.in_sensor), to.normalized().transpose(),
                Eigen::RowVector3d::Zero();
            hessian += J.transpose() * J / (kSigma * kSigma);
            gradient += J.transpose() * residual(s) / (kSigma * kSigma);
        }
        return cost();
    }

    double cost() override
    {
        double sum = 0;
        for (const Sight& s : sights_) sum += 0.5 * residual(s).squaredNorm() / (kSigma * kSigma);
        return sum;
    }

    void retract(const ProblemVector& d) override
    {
        estimate = {estimate.R * expSO3(d.tail<3>()), estimate.p + d.head<3>()};
    }
    void save() override { saved_ = estimate; }
    void restore() override { estimate = saved_; }

    ProblemMatrix chartJacobian(const ProblemVector& z) const override
    {
        ProblemMatrix J = ProblemMatrix::Identity(6, 6);
        J.bottomRightCorner<3, 3>() = rightJacobianSO3(z.tail<3>());
        return J;
    }

    ProblemVector maxStep() const override { return ProblemVector::Constant(6, max_step); }

    const Pose truth{expSO3({0.3, -0.8, 0.5}), {1, 2, -1}};
    Pose estimate;
    double max_step = 10;

 private:
    static constexpr double kSigma = 0.05;
    struct Sight
    {
        Vector3d in_sensor, position, beacon;
        double distance;
    };

    Eigen::Vector4d residual(const Sight& s) const
    {
        Eigen::Vector4d r;
        r << estimate * s.in_sensor - s.position, (estimate.p - s.beacon).norm() - s.distance;
        return r;
    }

    std::vector<Sight> sights_;
    Pose saved_;
};

/** One unknown on a line, with a residual of one's choice. */
class ScalarProblem : public LeastSquaresProblem
{
 public:
    int dimension() const override { return 1; }
    double linearize(ProblemMatrix& hessian, ProblemVector& gradient) override
    {
        hessian.setConstant(1, 1, slope() * slope());
        gradient.setConstant(1, slope() * residual());
        return cost();
    }
    double cost() override { return 0.5 * residual() * residual(); }
    void retract(const ProblemVector& d) override { x += d[0]; }
    void save() override { saved_ = x; }
    void restore() override { x = saved_; }
    ProblemMatrix chartJacobian(const ProblemVector&) const override
    {
        return ProblemMatrix::Identity(1, 1);
    }
    ProblemVector maxStep() const override { return ProblemVector::Constant(1, 1e9); }

    double x = 0;

 protected:
    virtual double residual() const = 0;
    virtual double slope() const = 0;

 private:
    double saved_ = 0;
};

/** Whose Gauss-Newton step overshoots by more than it goes forward, from |x| > 1.4 on. */
class OvershootingProblem : public ScalarProblem
{
    double residual() const override { return std::atan(x); }
    double slope() const override { return 1 / (1 + x * x); }
};

/** Not a number at all, or only from x = limit on. */
class NanProblem : public ScalarProblem
{
 public:
    explicit NanProblem(double limit) : limit_(limit) {}

 private:
    double residual() const override
    {
        return x >= limit_ ? std::numeric_limits<double>::quiet_NaN() : std::exp(x) - 3;
    }
    double slope() const override
    {
        return x >= limit_ ? std::numeric_limits<double>::quiet_NaN() : std::exp(x);
    }
    double limit_;
};

/** Nothing depends on the unknown. */
class SingularProblem : public ScalarProblem
{
    double residual() const override { return 1; }
    double slope() const override { return 0; }
};
}  // namespace taut::test
