// A motion of a car, step by step: a straight run-in until time 0, then what the motion says, until the car
// rests, rolls over or the time is up.
#pragma once

#include "balances.hpp"
#include "chrono_vehicle/terrain/FlatTerrain.h"
#include "direct_solver.hpp"
#include "record.hpp"

constexpr double kGravityM_s2 = 9.81;
// Roll angle at which the record of a car that turns over ends: the body has no contact with the ground.
constexpr double kRollOverRad = 0.8727;
constexpr double kLargestPitchRad = 1.0;
// So long a car stands still before its record ends, s.
constexpr double kRestS = 0.2;

// Bodies and links under gravity, solved directly.
class MultibodySystem : public chrono::ChSystemNSC {
  public:
    MultibodySystem() {
        SetGravitationalAcceleration(chrono::ChVector3d(0, 0, -kGravityM_s2));
        auto solver = chrono_types::make_shared<OrderedLU>();
        solver->UseSparsityPatternLearner(true);
        solver->LockSparsityPattern(true);
        SetSolver(solver);
    }
};

inline chrono::vehicle::DriverInputs no_inputs() {
    chrono::vehicle::DriverInputs inputs;
    inputs.m_steering = inputs.m_throttle = inputs.m_braking = 0;
    return inputs;
}

struct Outcome {
    int n_rows = 0;
    PlanarForce impulse_n_s;
    Works works;
    double start_energy_j = 0, end_energy_j = 0, energy_residual_j = 0, momentum_residual_n_s = 0;
    bool diverged = false, rolled_over = false, at_rest = false;
};

class Simulation {
  public:
    // `held_at_m`: point of the chassis at which the force acts that keeps the speed of the run-in.
    Simulation(const CarDescription& description, const BodyMass& body, const Motion& motion,
               const chrono::ChVector3d& held_at_m = chrono::ChVector3d(0, 0, 0))
        : m_motion(motion),
          m_road(0.0, static_cast<float>(motion.friction)),
          m_car(&m_system, description, body, motion.speed_m_s, motion.step_s),
          m_loads(m_car, motion),
          m_balances(m_system, m_car, m_loads, motion.step_s),
          m_inputs(no_inputs()),
          m_cg_in_chassis_m(held_at_m) {
        if (!motion.steer.is_empty() && !description.steering_table.is_known())
            throw std::runtime_error(description.name + ": has no steering table");
    }

    Car& car() { return m_car; }
    const chrono::ChSystem& system() const { return m_system; }
    Balances& balances() { return m_balances; }
    Pose pose() { return Pose::of(*m_car.GetChassisBody(), m_cg_in_chassis_m); }
    // After the run-in: a point of the chassis above or under the centre of gravity.
    chrono::ChVector3d point_at_height(double above_road_m) const {
        return m_cg_in_chassis_m + chrono::ChVector3d(0, 0, above_road_m - m_cg_height_m);
    }

    // Drives straight until time 0.
    void run_in() {
        const long n_steps = std::lround(m_motion.run_in_s / m_motion.step_s);
        for (long step = 0; step < n_steps; step++)
            advance(-m_motion.run_in_s + step * m_motion.step_s, false);
        const auto whole = whole_car(m_system);
        m_cg_in_chassis_m =
            m_car.GetChassisBody()->GetFrameRefToAbs().TransformPointParentToLocal(whole.cg_m);
        m_cg_in_chassis_m.y() = 0;
        m_cg_height_m = whole.cg_m.z();
        for (auto& body : m_system.GetBodies())
            body->SetPosDt(body->GetPosDt() + chrono::ChVector3d(0, m_motion.sideways_kick_m_s, 0));
        m_start_m = pose().cg_m;
    }

    Outcome drive(const std::string& record_file) {
        run_in();
        m_balances.begin();
        Record record(record_file);
        Outcome outcome;
        int n_rows_at_rest = 0;
        const int n_rows_of_rest = std::lround(kRestS / m_motion.output_interval_s);
        for (long step = 0;; step++) {
            const double time_s = step * m_motion.step_s;
            const Pose before = pose();
            const double yaw_rad = m_turns.unwrapped(before.yaw_rad);
            const std::array<double, 2> front_angle_rad = {m_car.GetSteeringAngle(0, chrono::vehicle::LEFT),
                                                           m_car.GetSteeringAngle(0, chrono::vehicle::RIGHT)};
            advance(time_s, true);
            if (is_output(time_s, outcome.n_rows)) {
                const RecordRow row = record_row(time_s, before, yaw_rad, front_angle_rad);
                record.write(row);
                outcome.n_rows++;
                const bool rests = row.is_at_rest() && time_s > m_motion.force.end_s();
                n_rows_at_rest = rests ? n_rows_at_rest + 1 : 0;
            }
            outcome.diverged =
                !std::isfinite(before.cg_m.x()) || std::abs(before.pitch_rad) > kLargestPitchRad;
            outcome.rolled_over = std::abs(before.roll_rad) > kRollOverRad;
            outcome.at_rest = n_rows_at_rest >= n_rows_of_rest;
            const double last_s = m_motion.longest_s - m_motion.output_interval_s + 0.5 * m_motion.step_s;
            if (outcome.diverged || outcome.rolled_over || time_s > last_s ||
                (m_motion.stop_at_rest && outcome.at_rest))
                break;
        }
        outcome.impulse_n_s = m_motion.force.total();
        outcome.works = m_balances.works();
        outcome.start_energy_j = m_balances.start_energy_j();
        outcome.end_energy_j = m_balances.end_energy_j();
        outcome.energy_residual_j = m_balances.energy_residual_j();
        outcome.momentum_residual_n_s = m_balances.momentum_residual_n_s();
        return outcome;
    }

    // One step under all forces. `input` of the steering holds where the motion steers nothing.
    void advance(double time_s, bool has_started) {
        if (has_started && !m_motion.steer.is_empty())
            m_inputs.m_steering = m_car.description().steering_table.input_at(m_motion.steer.at(time_s));
        m_car.Synchronize(time_s, m_inputs, m_road);
        m_loads.apply(pose(), time_s, has_started, m_cg_in_chassis_m, m_cg_height_m);
        m_car.update_tires(time_s, m_inputs);
        if (has_started)
            m_balances.before_step();
        // Without it the forces on the bodies are those that were collected at the end of the last step.
        m_system.ForceUpdate();
        m_system.DoStepDynamics(m_motion.step_s);
        if (has_started)
            m_balances.after_step();
    }

    void set_steering_input(double input) { m_inputs.m_steering = input; }

  private:
    bool is_output(double time_s, int n_rows) const {
        return time_s >= n_rows * m_motion.output_interval_s - 0.25 * m_motion.step_s &&
               time_s < m_motion.longest_s - 0.25 * m_motion.output_interval_s;
    }

    RecordRow record_row(double time_s, const Pose& pose, double yaw_rad,
                         const std::array<double, 2>& front_angle_rad) {
        RecordRow row;
        row.time_s = time_s;
        row.x_m = pose.cg_m.x() - m_start_m.x();
        row.y_m = pose.cg_m.y() - m_start_m.y();
        row.yaw_rad = yaw_rad;
        row.roll_rad = pose.roll_rad;
        row.forward_m_s = pose.forward(pose.velocity_m_s);
        row.left_m_s = pose.left(pose.velocity_m_s);
        row.yaw_rate_rad_s = pose.yaw_rate_rad_s();
        row.roll_rate_rad_s = pose.roll_rate_rad_s();
        row.mean_force = m_motion.force.mean(time_s, time_s + m_motion.output_interval_s);
        row.front_angle_rad = front_angle_rad;
        for (int wheel = 0; wheel < kWheels; wheel++)
            row.load_n[wheel] = m_car.corner(wheel).tire->state().load_n;
        return row;
    }

    const Motion& m_motion;
    MultibodySystem m_system;
    chrono::vehicle::FlatTerrain m_road;
    Car m_car;
    Loads m_loads;
    Balances m_balances;
    chrono::vehicle::DriverInputs m_inputs;
    TurnCounter m_turns;
    // Before time 0 the point at which the speed is held.
    chrono::ChVector3d m_cg_in_chassis_m, m_start_m{0, 0, 0};
    double m_cg_height_m = 0;
};
