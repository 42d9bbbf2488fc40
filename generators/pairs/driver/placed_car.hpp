// A car of a pair: computed in axes of its own, in which it starts along x, and placed on the road.
#pragma once

#include "../../cars/driver/simulation.hpp"
#include "contact.hpp"
#include "request.hpp"

// What the driver of a car, and the systems of the car, do in a step.
struct Controls {
    // Mean angle of the front wheels that is wanted.
    double steer_rad = 0;
    std::array<double, kWheels> brake_n_m{0, 0, 0, 0};
    // At each driven wheel.
    double drive_n_m = 0;

    double brakes_n_m() const { return brake_n_m[0] + brake_n_m[1] + brake_n_m[2] + brake_n_m[3]; }
};

// Where the car is on the road and how it moves: of its centre of gravity, velocities in its own axes.
struct CarState {
    double x_m = 0, y_m = 0, yaw_rad = 0, roll_rad = 0, pitch_rad = 0;
    double forward_m_s = 0, left_m_s = 0, yaw_rate_rad_s = 0, roll_rate_rad_s = 0;
    std::array<double, 2> front_angle_rad{0, 0};

    double speed_m_s() const { return std::hypot(forward_m_s, left_m_s); }
    double front_mean_rad() const { return 0.5 * (front_angle_rad[0] + front_angle_rad[1]); }
    bool is_at_rest() const { return speed_m_s() < 0.03 && std::abs(yaw_rate_rad_s) < 0.02; }
};

class PlacedCar {
  public:
    PlacedCar(const CarRequest& request, double friction, double step_s, double contact_height_m)
        : m_request(request),
          m_description(CarDescription::read(request.car_file)),
          m_body(solve_body(m_description)),
          m_motion(motion(request, friction, step_s)),
          m_simulation(m_description, m_body, m_motion) {
        if (!m_description.steering_table.is_known())
            throw std::runtime_error(m_description.name + ": has no steering table");
        m_simulation.run_in();
        m_simulation.balances().begin();
        m_push_point_m = m_simulation.point_at_height(contact_height_m);
        m_start_m = m_simulation.pose().cg_m;
    }
    PlacedCar(const PlacedCar&) = delete;
    PlacedCar& operator=(const PlacedCar&) = delete;

    void place(double x_m, double y_m, double heading_rad) {
        m_x_m = x_m;
        m_y_m = y_m;
        m_heading_rad = heading_rad;
        look();
    }
    void move_along_x(double by_m) {
        m_x_m += by_m;
        look();
    }

    const CarDescription& description() const { return m_description; }
    const CarRequest& request() const { return m_request; }
    const CarState& state() const { return m_state; }
    // Of its axes at the height of the contact.
    const PlanarMotion& motion_in_plan() const { return m_plan; }
    double slip_ratio(int wheel) { return m_simulation.car().corner(wheel).tire->state().slip_ratio; }
    Balances& balances() { return m_simulation.balances(); }
    double contact_work_j() const { return m_contact_work_j; }

    double weight_n() const { return m_description.mass_kg * kGravityM_s2; }
    double rolling_radius_m(int axle) const { return m_description.axles[axle].rolling_radius_m; }

    // One step; force and moment of the contact on this car, axes of the road.
    void advance(double time_s, const Controls& controls, double x_n, double y_n, double moment_n_m) {
        const double c = std::cos(m_heading_rad), s = std::sin(m_heading_rad);
        StepInputs& inputs = m_motion.inputs;
        inputs.brake_n_m = controls.brake_n_m;
        inputs.drive_n_m = {0, 0, 0, 0};
        for (int wheel = 0; wheel < kWheels; wheel++)
            if (axle_of(wheel) == m_request.driven_axle)
                inputs.drive_n_m[wheel] = controls.drive_n_m;
        inputs.is_pushed = x_n != 0 || y_n != 0 || moment_n_m != 0;
        inputs.push_n = {c * x_n + s * y_n, -s * x_n + c * y_n, 0};
        inputs.push_point_m = m_push_point_m;
        inputs.push_moment_n_m = moment_n_m;
        m_simulation.set_steering_input(m_description.steering_table.input_at(controls.steer_rad));
        const PlanarMotion before = m_plan;
        m_simulation.advance(time_s, true);
        look();
        const double x_m_s = 0.5 * (before.vx_m_s + m_plan.vx_m_s);
        const double y_m_s = 0.5 * (before.vy_m_s + m_plan.vy_m_s);
        const double rate_rad_s = 0.5 * (before.yaw_rate_rad_s + m_plan.yaw_rate_rad_s);
        m_contact_work_j += m_motion.step_s * (x_n * x_m_s + y_n * y_m_s + moment_n_m * rate_rad_s);
    }

  private:
    static Motion motion(const CarRequest& request, double friction, double step_s) {
        Motion motion;
        motion.speed_m_s = request.speed_m_s;
        motion.friction = friction;
        motion.step_s = step_s;
        return motion;
    }

    void look() {
        const Pose pose = m_simulation.pose();
        const double c = std::cos(m_heading_rad), s = std::sin(m_heading_rad);
        const auto on_road = [&](const chrono::ChVector3d& of) {
            const double x = of.x() - m_start_m.x(), y = of.y() - m_start_m.y();
            return Point{m_x_m + c * x - s * y, m_y_m + s * x + c * y};
        };
        const Point cg = on_road(pose.cg_m);
        const double yaw_rad = m_turns.unwrapped(pose.yaw_rad) + m_heading_rad;
        Car& car = m_simulation.car();
        m_state = {cg.x, cg.y, yaw_rad, pose.roll_rad, pose.pitch_rad, pose.forward(pose.velocity_m_s),
                   pose.left(pose.velocity_m_s), pose.yaw_rate_rad_s(), pose.roll_rate_rad_s(),
                   {car.GetSteeringAngle(0, chrono::vehicle::LEFT),
                    car.GetSteeringAngle(0, chrono::vehicle::RIGHT)}};
        const Point at = on_road(pose.frame.TransformPointLocalToParent(m_push_point_m));
        const auto velocity = pose.frame.PointSpeedLocalToParent(m_push_point_m);
        m_plan = {at.x, at.y, yaw_rad, c * velocity.x() - s * velocity.y(),
                  s * velocity.x() + c * velocity.y(), pose.frame.GetAngVelParent().z()};
    }

    const CarRequest& m_request;
    CarDescription m_description;
    BodyMass m_body;
    Motion m_motion;
    Simulation m_simulation;
    chrono::ChVector3d m_push_point_m{0, 0, 0}, m_start_m{0, 0, 0};
    double m_x_m = 0, m_y_m = 0, m_heading_rad = 0;
    TurnCounter m_turns;
    CarState m_state;
    PlanarMotion m_plan;
    double m_contact_work_j = 0;
};
