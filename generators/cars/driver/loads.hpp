// Forces on the car beside those of tires, springs and dampers: anti-roll bars, brakes, engine, air, and what
// pushes the body. They are given for one step and act on the bodies through accumulators.
#pragma once

#include "car.hpp"
#include "motion.hpp"

// Heading of the car, and where its centre of gravity is.
struct Pose {
    chrono::ChFrameMoving<> frame;
    double yaw_rad, pitch_rad, roll_rad, cos_yaw, sin_yaw;
    chrono::ChVector3d cg_m, velocity_m_s;

    static Pose of(chrono::ChBodyAuxRef& body, const chrono::ChVector3d& cg_in_chassis_m) {
        Pose pose;
        pose.frame = body.GetFrameRefToAbs();
        const auto& rotation = pose.frame.GetRotMat();
        pose.yaw_rad = std::atan2(rotation(1, 0), rotation(0, 0));
        pose.pitch_rad = -std::asin(std::max(-1.0, std::min(1.0, rotation(2, 0))));
        pose.roll_rad = std::atan2(rotation(2, 1), rotation(2, 2));
        pose.cos_yaw = std::cos(pose.yaw_rad);
        pose.sin_yaw = std::sin(pose.yaw_rad);
        pose.cg_m = pose.frame.TransformPointLocalToParent(cg_in_chassis_m);
        pose.velocity_m_s = pose.frame.PointSpeedLocalToParent(cg_in_chassis_m);
        return pose;
    }

    // A horizontal vector along and across the heading, in the axes of the world.
    chrono::ChVector3d to_world(double forward, double left) const {
        return {forward * cos_yaw - left * sin_yaw, forward * sin_yaw + left * cos_yaw, 0};
    }
    double forward(const chrono::ChVector3d& of) const { return of.x() * cos_yaw + of.y() * sin_yaw; }
    double left(const chrono::ChVector3d& of) const { return -of.x() * sin_yaw + of.y() * cos_yaw; }
    double yaw_rate_rad_s() const { return turning_rad_s() / std::cos(pitch_rad); }
    double roll_rate_rad_s() const {
        return frame.GetAngVelLocal().x() + std::tan(pitch_rad) * turning_rad_s();
    }

  private:
    double turning_rad_s() const {
        const auto spin = frame.GetAngVelLocal();
        return spin.y() * std::sin(roll_rad) + spin.z() * std::cos(roll_rad);
    }
};

// What acts at a wheel in a step, axes of the world.
struct CornerLoad {
    chrono::ChVector3d bar_force_n{0, 0, 0}, bar_point_m{0, 0, 0}, brake_torque_n_m{0, 0, 0};
    bool is_braked = false;
};

class Loads {
  public:
    Loads(Car& car, const Motion& motion)
        : m_car(car), m_motion(motion), m_body_forces(car.GetChassisBody()->AddAccumulator()) {}

    unsigned body_forces() const { return m_body_forces; }
    const CornerLoad& corner(int wheel) const { return m_corners[wheel]; }

    // Gives the forces of the step from `time_s` on; before time 0 only what keeps the car rolling straight.
    void apply(const Pose& pose, double time_s, bool has_started, const chrono::ChVector3d& cg_in_chassis_m,
               double cg_height_m) {
        clear();
        apply_anti_roll_bars(pose);
        apply_brakes(time_s, has_started);
        auto& body = *m_car.GetChassisBody();
        if (has_started && !m_motion.force.is_empty()) {
            const PlanarForce force = m_motion.force.mean(time_s, time_s + m_motion.step_s);
            const auto& at = m_motion.point_m;
            const auto point = pose.frame.TransformPointLocalToParent(
                cg_in_chassis_m + chrono::ChVector3d(at.x(), at.y(), at.z() - cg_height_m));
            if (force.x_n != 0 || force.y_n != 0)
                body.AccumulateForce(m_body_forces, pose.to_world(force.x_n, force.y_n), point, false);
        }
        const StepInputs& inputs = m_motion.inputs;
        if (has_started && inputs.is_pushed) {
            const auto point = pose.frame.TransformPointLocalToParent(inputs.push_point_m);
            body.AccumulateForce(m_body_forces, inputs.push_n, point, false);
            body.AccumulateTorque(m_body_forces, chrono::ChVector3d(0, 0, inputs.push_moment_n_m), false);
        }
        if (has_started && m_motion.roll_moment_n_m != 0 && time_s < m_motion.roll_moment_until_s)
            body.AccumulateTorque(m_body_forces, pose.to_world(m_motion.roll_moment_n_m, 0), false);
        if (m_motion.hold_speed || !has_started) {
            const double missing_m_s = m_motion.speed_m_s - pose.forward(pose.velocity_m_s);
            body.AccumulateForce(m_body_forces, pose.to_world(kSpeedHoldN_s_m * missing_m_s, 0), pose.cg_m,
                                 false);
        }
        const double drag = 0.5 * kAirDensityKg_m3 * m_car.description().drag_area_m2;
        body.AccumulateForce(m_body_forces, pose.velocity_m_s * (-drag * pose.velocity_m_s.Length()),
                             pose.cg_m, false);
    }

  private:
    static constexpr double kAirDensityKg_m3 = 1.2;
    // Gain of the force that holds the speed.
    static constexpr double kSpeedHoldN_s_m = 2e4;
    // Spin inertia that turns with a wheel beside its own, and the margin by which a brake may not reverse a
    // wheel within a step.
    static constexpr double kInertiaBesideWheelKg_m2 = 0.4;
    static constexpr double kReversalMargin = 1.2;
    // Wheel speed over which the drag of the engine builds up, rad/s.
    static constexpr double kEngineSpeedRad_s = 3.0;

    void clear() {
        m_car.GetChassisBody()->EmptyAccumulator(m_body_forces);
        for (int wheel = 0; wheel < kWheels; wheel++) {
            auto& corner = m_car.corner(wheel);
            corner.spindle->EmptyAccumulator(corner.spindle_forces);
            corner.carrier->EmptyAccumulator(corner.carrier_forces);
            m_corners[wheel] = CornerLoad{};
        }
    }

    // Ideal bars: a vertical force (axes of the chassis) at the wheel centres, with its reaction on the
    // chassis at the same points.
    void apply_anti_roll_bars(const Pose& pose) {
        auto& body = *m_car.GetChassisBody();
        const auto up = pose.frame.GetRotMat().GetAxisZ();
        std::array<double, kWheels> travel_m;
        for (int wheel = 0; wheel < kWheels; wheel++) {
            auto& corner = m_car.corner(wheel);
            m_corners[wheel].bar_point_m = corner.spindle->GetPos();
            travel_m[wheel] = pose.frame.TransformPointParentToLocal(m_corners[wheel].bar_point_m).z() -
                              corner.design_position_m.z();
        }
        for (int axle = 0; axle < 2; axle++) {
            const double stiffness_n_m = m_car.description().axles[axle].anti_roll_bar_n_m;
            if (stiffness_n_m <= 0)
                continue;
            const int left = 2 * axle, right = left + 1;
            const double force_n = stiffness_n_m * (travel_m[left] - travel_m[right]);
            m_corners[left].bar_force_n = up * -force_n;
            m_corners[right].bar_force_n = up * force_n;
            for (int wheel : {left, right}) {
                auto& corner = m_car.corner(wheel);
                const auto& load = m_corners[wheel];
                corner.carrier->AccumulateForce(corner.carrier_forces, load.bar_force_n, load.bar_point_m,
                                                false);
                body.AccumulateForce(m_body_forces, load.bar_force_n * -1.0, load.bar_point_m, false);
            }
        }
    }

    // Torque between wheel and carrier about the axis of the wheel; that of a brake is implicit in the speed
    // of the wheel, so that a wheel can stand still.
    void apply_brakes(double time_s, bool has_started) {
        if (!has_started)
            return;
        std::array<double, kWheels> spin_rad_s, torque_n_m{0, 0, 0, 0};
        for (int wheel = 0; wheel < kWheels; wheel++) {
            auto& corner = m_car.corner(wheel);
            const auto axis = corner.spindle->GetRotMat().GetAxisY();
            spin_rad_s[wheel] =
                Vdot(axis, corner.spindle->GetAngVelParent() - corner.carrier->GetAngVelParent());
            const double largest =
                m_motion.brakes.largest_torque_n_m(wheel, time_s) + m_motion.inputs.brake_n_m[wheel];
            const double inertia =
                m_car.description().axles[axle_of(wheel)].wheel_spin_inertia_kg_m2 + kInertiaBesideWheelKg_m2;
            const double slow_rad_s = kReversalMargin * largest * m_motion.step_s / inertia;
            if (largest > 0)
                torque_n_m[wheel] -=
                    largest * spin_rad_s[wheel] / std::max(std::abs(spin_rad_s[wheel]), slow_rad_s);
            torque_n_m[wheel] += m_motion.inputs.drive_n_m[wheel];
        }
        const int driven = 2 * m_motion.engine.axle;
        if (m_motion.engine.torque_n_m > 0) {
            const double mean_rad_s = 0.5 * (spin_rad_s[driven] + spin_rad_s[driven + 1]);
            for (int wheel : {driven, driven + 1})
                torque_n_m[wheel] -= m_motion.engine.torque_n_m * std::tanh(mean_rad_s / kEngineSpeedRad_s);
        }
        for (int wheel = 0; wheel < kWheels; wheel++) {
            if (torque_n_m[wheel] == 0)
                continue;
            auto& corner = m_car.corner(wheel);
            auto& load = m_corners[wheel];
            load.is_braked = true;
            load.brake_torque_n_m = corner.spindle->GetRotMat().GetAxisY() * torque_n_m[wheel];
            corner.spindle->AccumulateTorque(corner.spindle_forces, load.brake_torque_n_m, false);
            corner.carrier->AccumulateTorque(corner.carrier_forces, load.brake_torque_n_m * -1.0, false);
        }
    }

    Car& m_car;
    const Motion& m_motion;
    unsigned m_body_forces;
    std::array<CornerLoad, kWheels> m_corners;
};
