#pragma once

#include <limits>

#include "taut/core/Solver.h"
#include "taut/factors/ImuFactor.h"
#include "taut/factors/LidarFactor.h"
#include "taut/odometry/OdometryConfig.h"

namespace taut
{
/** A state with the information (inverse covariance) of its error. */
struct NavPrior
{
    NavState state;
    NavState::Matrix information = NavState::Matrix::Identity();

    /** Covariance of one part of the error state, given by its first row. */
    Matrix3d covarianceOf(int part) const;
    /** Gives one part another covariance; what tied it to the others is lost. */
    void forget(int part, const Matrix3d& covariance);
};

/** What is known of a state without a measurement: where a body rests, or how it went on through a
 * gap. Each part has one standard deviation; infinite: nothing is known. */
struct MotionPrior
{
    Pose T_world_imu;
    double position_sigma = std::numeric_limits<double>::infinity();  //!< [m] about T_world_imu
    double rotation_sigma = std::numeric_limits<double>::infinity();  //!< [rad] about any axis
    double velocity_sigma = std::numeric_limits<double>::infinity();  //!< [m/s] about v_world
    Vector3d v_world = Vector3d::Zero();                              //!< [m/s]
};

/** The cost of one scan (paper, equation 17): IMU factor, LiDAR factors, absolute bias prior,
 * the motion prior and, where the previous state is released, its prior.
 * Unknowns: (x_{k-1}, x_k), or x_k alone. */
class ScanProblem : public LeastSquaresProblem
{
 public:
    ScanProblem(
        const NavPrior& previous, const PreintegratedImu& imu, const LidarFactor& lidar,
        SweepPath& path, const EstimationConfig& config);

    int dimension() const override;
    double linearize(ProblemMatrix& hessian, ProblemVector& gradient) override;
    double cost() override;
    void retract(const ProblemVector& delta) override;
    void save() override;
    void restore() override;
    ProblemMatrix chartJacobian(const ProblemVector& z) const override;
    ProblemVector maxStep() const override;

    /** Begins anew: at the prior's x_{k-1} and the given x_k. */
    void startFrom(const NavState& current);

    const NavState& previous() const { return previous_; }
    const NavState& current() const { return current_; }

    /** Covariance of x_k as it is predicted: before LiDAR and rest are asked. */
    const NavState::Matrix& predictedCovariance() const { return predicted_; }
    /** Of its (p, theta). */
    LidarFactor::PoseCovariance predictedPoseCovariance() const;

    /** Factor on the LiDAR noise. */
    void setBalance(double balance)
    {
        balance_ = balance;
        linearized_ = false;
    }
    /** What is known of the body at t_k if it rests. */
    void setMotionPrior(const MotionPrior& prior)
    {
        motion_prior_ = prior;
        linearized_ = false;
    }
    /** Without LiDAR the problem is prediction and prior alone. */
    void useLidar(bool use)
    {
        use_lidar_ = use;
        linearized_ = false;
    }

    /** Linearises at the current estimate, unless that was the last thing done. */
    void relinearize();

    /** Hessian of the LiDAR block by x_k alone at the last linearisation: what the scan says of
     * each direction. */
    NavState::Matrix lidarInformation() const;

    /** Information of x_k after x_{k-1} is marginalised, at the last linearisation. */
    NavState::Matrix marginalInformation() const;

 private:
    bool released() const { return config_.previous_state == PreviousState::Released; }
    double addPrior(ProblemMatrix& H, ProblemVector& g) const;
    double addImu(ProblemMatrix& H, ProblemVector& g) const;
    double addBiasPrior(ProblemMatrix& H, ProblemVector& g) const;
    double addRest(ProblemMatrix& H, ProblemVector& g) const;
    double addAllButLidar(ProblemMatrix& H, ProblemVector& g) const;

    const NavPrior& prior_;
    const PreintegratedImu& imu_;
    const LidarFactor& lidar_;
    SweepPath& path_;
    const EstimationConfig& config_;
    NavState previous_, current_, saved_previous_, saved_current_;
    NavState::Matrix imu_information_, predicted_;
    ProblemMatrix hessian_, lidar_hessian_;  // of the last linearisation
    bool linearized_ = false;                // at the current estimate, noise and correspondences
    double balance_ = 1;
    bool use_lidar_ = true;
    MotionPrior motion_prior_;
};
}  // namespace taut
