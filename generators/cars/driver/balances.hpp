// Balances of momentum and energy over a motion. Each force of a step times the mean of the velocities before
// and after it is its work: exact for the kinetic energy.
#pragma once

#include "chrono/physics/ChLinkLock.h"
#include "chrono/physics/ChLinkMotorRotationAngle.h"
#include "chrono/physics/ChLinkRSDA.h"
#include "chrono/physics/ChLinkTSDA.h"
#include "loads.hpp"
#include "mass_properties.hpp"

struct Works {
    double outer_forces_j = 0, tires_j = 0, gravity_j = 0, springs_and_dampers_j = 0, brakes_j = 0,
           anti_roll_bars_j = 0, steering_j = 0;

    double sum_j() const {
        return outer_forces_j + tires_j + gravity_j + springs_and_dampers_j + brakes_j + anti_roll_bars_j +
               steering_j;
    }
};

class Balances {
  public:
    Balances(chrono::ChSystem& system, Car& car, const Loads& loads, double step_s)
        : m_system(system), m_car(car), m_loads(loads), m_step_s(step_s) {
        for (auto& link : system.GetLinks()) {
            if (auto spring = std::dynamic_pointer_cast<chrono::ChLinkTSDA>(link))
                m_springs.push_back({spring});
            if (auto spring = std::dynamic_pointer_cast<chrono::ChLinkRSDA>(link))
                m_twists.push_back({spring});
            if (is_steering_drive(link->GetName()))
                if (auto drive = std::dynamic_pointer_cast<chrono::ChLink>(link))
                    m_drives.push_back({drive});
        }
    }

    void begin() { m_start = momentum(m_system); }

    // Called with all forces of a step given and before it.
    void before_step() {
        auto& body = *m_car.GetChassisBody();
        m_body = {body.GetPosDt(), body.GetAngVelParent()};
        m_body_force_n = body.GetAccumulatedForce(m_loads.body_forces());
        m_body_torque_n_m =
            body.TransformDirectionLocalToParent(body.GetAccumulatedTorque(m_loads.body_forces()));
        for (int wheel = 0; wheel < kWheels; wheel++)
            before_step(m_wheels[wheel], m_car.corner(wheel), m_loads.corner(wheel));
        for (auto& spring : m_springs)
            spring.note(spring.link->GetForce());
        for (auto& twist : m_twists)
            twist.note(twist.link->GetTorque());
        for (auto& drive : m_drives)
            drive.before_step();
        m_gravity_power_w = gravity_power_w();
    }

    void after_step() {
        auto& body = *m_car.GetChassisBody();
        m_works.outer_forces_j += work(m_body_force_n, m_body.velocity_m_s, body.GetPosDt()) +
                                  work(m_body_torque_n_m, m_body.spin_rad_s, body.GetAngVelParent());
        m_outer_impulse_n_s += m_body_force_n * m_step_s;
        for (int wheel = 0; wheel < kWheels; wheel++)
            after_step(m_wheels[wheel], m_car.corner(wheel), m_loads.corner(wheel));
        for (const auto& spring : m_springs)
            m_works.springs_and_dampers_j += spring.work_j(m_step_s);
        for (const auto& twist : m_twists)
            m_works.springs_and_dampers_j += twist.work_j(m_step_s);
        for (const auto& drive : m_drives)
            m_works.steering_j += drive.work_j(m_step_s);
        m_works.gravity_j += 0.5 * m_step_s * (m_gravity_power_w + gravity_power_w());
    }

    const Works& works() const { return m_works; }
    double start_energy_j() const { return m_start.kinetic_energy_j; }
    double end_energy_j() const { return momentum(m_system).kinetic_energy_j; }
    double energy_residual_j() const { return end_energy_j() - start_energy_j() - m_works.sum_j(); }
    // Change of the horizontal momentum that no outer force explains.
    double momentum_residual_n_s() const {
        const auto residual =
            momentum(m_system).linear_n_s - m_start.linear_n_s - m_outer_impulse_n_s - m_tire_impulse_n_s;
        return std::hypot(residual.x(), residual.y());
    }

  private:
    struct Velocities {
        chrono::ChVector3d velocity_m_s, spin_rad_s;
    };
    struct WheelBefore {
        Velocities spindle, carrier;
        chrono::ChVector3d tire_force_n, tire_torque_n_m;
    };
    // A spring, damper or both, with its force and speed before the step.
    template <class Link>
    struct Element {
        std::shared_ptr<Link> link;
        double force = 0, speed = 0;

        void note(double force_before) {
            force = force_before;
            speed = link->GetVelocity();
        }
        double work_j(double step_s) const { return step_s * force * 0.5 * (speed + link->GetVelocity()); }
    };
    // The link that moves the steering: its reactions on both bodies do work while it moves.
    struct Drive {
        std::shared_ptr<chrono::ChLink> link;
        chrono::ChFramed frame{};
        chrono::ChVector3d velocity_m_s{}, spin_rad_s{};

        // Motion of the second body against the first, at the link.
        Velocities relative() const {
            const auto at = link->GetFrame2Abs().GetPos();
            const auto* one = link->GetBody1();
            const auto* two = link->GetBody2();
            const auto velocity = [&](const chrono::ChBodyFrame* body) {
                return body->PointSpeedLocalToParent(body->TransformPointParentToLocal(at));
            };
            return {velocity(two) - velocity(one), two->GetAngVelParent() - one->GetAngVelParent()};
        }
        void before_step() {
            frame = link->GetFrame2Abs();
            const auto now = relative();
            velocity_m_s = now.velocity_m_s;
            spin_rad_s = now.spin_rad_s;
        }
        double work_j(double step_s) const {
            const auto now = relative();
            const auto reaction = link->GetReaction2();
            const auto force_n = frame.TransformDirectionLocalToParent(reaction.force);
            const auto torque_n_m = frame.TransformDirectionLocalToParent(reaction.torque);
            return step_s * (Vdot(force_n, (velocity_m_s + now.velocity_m_s) * 0.5) +
                             Vdot(torque_n_m, (spin_rad_s + now.spin_rad_s) * 0.5));
        }
    };

    // Names that Chrono gives to the actuator of a rack and to the motor of a steering arm.
    static bool is_steering_drive(const std::string& name) {
        const auto ends_with = [&](const std::string& end) {
            return name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
        };
        return name.find("Susp") == std::string::npos && (ends_with("_actuator") || ends_with("_revolute"));
    }

    void before_step(WheelBefore& before, Car::Corner& corner, const CornerLoad& load) {
        auto& spindle = *corner.spindle;
        auto& carrier = *corner.carrier;
        before.spindle = {spindle.GetPosDt(), spindle.GetAngVelParent()};
        before.carrier = {
            carrier.PointSpeedLocalToParent(carrier.TransformPointParentToLocal(load.bar_point_m)),
            carrier.GetAngVelParent()};
        before.tire_force_n = spindle.GetAccumulatedForce(spindle.GetTireAccumulatorIndex());
        before.tire_torque_n_m = spindle.TransformDirectionLocalToParent(
            spindle.GetAccumulatedTorque(spindle.GetTireAccumulatorIndex()));
    }

    void after_step(const WheelBefore& before, Car::Corner& corner, const CornerLoad& load) {
        auto& spindle = *corner.spindle;
        auto& carrier = *corner.carrier;
        m_works.tires_j += work(before.tire_force_n, before.spindle.velocity_m_s, spindle.GetPosDt()) +
                           work(before.tire_torque_n_m, before.spindle.spin_rad_s, spindle.GetAngVelParent());
        m_tire_impulse_n_s += before.tire_force_n * m_step_s;
        if (load.is_braked)
            m_works.brakes_j +=
                work(load.brake_torque_n_m, before.spindle.spin_rad_s - before.carrier.spin_rad_s,
                     spindle.GetAngVelParent() - carrier.GetAngVelParent());
        const auto carrier_after =
            carrier.PointSpeedLocalToParent(carrier.TransformPointParentToLocal(spindle.GetPos()));
        m_works.anti_roll_bars_j += work(load.bar_force_n, before.carrier.velocity_m_s, carrier_after);
        // The reaction of the bar is among the forces on the body.
        m_outer_impulse_n_s += load.bar_force_n * m_step_s;
    }

    double work(const chrono::ChVector3d& force, const chrono::ChVector3d& before,
                const chrono::ChVector3d& after) const {
        return m_step_s * Vdot(force, (before + after) * 0.5);
    }

    double gravity_power_w() const {
        double power_w = 0;
        for (auto& body : m_system.GetBodies())
            power_w += body->GetMass() * Vdot(m_system.GetGravitationalAcceleration(), body->GetPosDt());
        return power_w;
    }

    chrono::ChSystem& m_system;
    Car& m_car;
    const Loads& m_loads;
    double m_step_s;
    std::vector<Element<chrono::ChLinkTSDA>> m_springs;
    std::vector<Element<chrono::ChLinkRSDA>> m_twists;
    std::vector<Drive> m_drives;
    Momentum m_start;
    Works m_works;
    chrono::ChVector3d m_outer_impulse_n_s{0, 0, 0}, m_tire_impulse_n_s{0, 0, 0};
    Velocities m_body;
    chrono::ChVector3d m_body_force_n, m_body_torque_n_m;
    std::array<WheelBefore, kWheels> m_wheels;
    double m_gravity_power_w = 0;
};
