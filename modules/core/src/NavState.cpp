#include "taut/core/NavState.h"

namespace taut
{
NavState NavState::retract(const Vector& delta) const
{
    NavState s = *this;
    s.T_world_imu.p += delta.segment<3>(kPosition);
    s.v_world += delta.segment<3>(kVelocity);
    s.T_world_imu.R =
        normalizedRotation(T_world_imu.R * expSO3(Vector3d(delta.segment<3>(kRotation))));
    s.bias_accel += delta.segment<3>(kBiasAccel);
    s.bias_gyro += delta.segment<3>(kBiasGyro);
    return s;
}

NavState::Vector NavState::localFrom(const NavState& origin) const
{
    Vector d;
    d.segment<3>(kPosition) = T_world_imu.p - origin.T_world_imu.p;
    d.segment<3>(kVelocity) = v_world - origin.v_world;
    d.segment<3>(kRotation) = logSO3(origin.T_world_imu.R.transpose() * T_world_imu.R);
    d.segment<3>(kBiasAccel) = bias_accel - origin.bias_accel;
    d.segment<3>(kBiasGyro) = bias_gyro - origin.bias_gyro;
    return d;
}
}  // namespace taut
