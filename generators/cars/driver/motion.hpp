// What a car is asked to do: its speed, the road, what pushes, brakes and steers it, and how it is computed.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "force_history.hpp"

// Friction brakes: torque at each wheel against its rotation, from a time on, with a linear rise.
struct Brakes {
    double start_s = 1e9, rise_s = 1;
    std::array<double, 4> torque_n_m{0, 0, 0, 0};

    double largest_torque_n_m(int wheel, double time_s) const {
        if (time_s < start_s)
            return 0;
        return torque_n_m[wheel] * std::min(1.0, (time_s - start_s) / std::max(rise_s, 1e-6));
    }
};

// Drag of the engine at both wheels of an axle, through an open differential.
struct EngineDrag {
    int axle = 1;
    double torque_n_m = 0;
};

// Angle of the front wheels over time, linear between its points and held after the last one.
struct SteerHistory {
    std::vector<double> time_s, angle_rad;

    bool is_empty() const { return time_s.empty(); }

    double at(double time) const {
        if (time <= time_s.front())
            return angle_rad.front();
        for (size_t i = 1; i < time_s.size(); i++)
            if (time <= time_s[i]) {
                const double share = (time - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
                return angle_rad[i - 1] + share * (angle_rad[i] - angle_rad[i - 1]);
            }
        return angle_rad.back();
    }
};

// What is set anew before each step of a car whose driver reacts or that another car pushes.
struct StepInputs {
    // Torques at the wheels: of the brake, against their rotation, and of the engine.
    std::array<double, 4> brake_n_m{0, 0, 0, 0}, drive_n_m{0, 0, 0, 0};
    // Push on the body, axes of the world: a horizontal force at a point of the chassis and a moment about
    // the vertical.
    bool is_pushed = false;
    chrono::ChVector3d push_n{0, 0, 0}, push_point_m{0, 0, 0};
    double push_moment_n_m = 0;
};

struct Motion {
    double speed_m_s, friction;
    double longest_s = 8;
    // Steps of the integration and of the record, and the straight drive before time 0.
    double step_s = 5e-4, output_interval_s = 0.01, run_in_s = 1;
    bool stop_at_rest = true;
    // A force along the heading at the centre of gravity keeps the speed (for tests on the car).
    bool hold_speed = false;
    // A moment about the heading, from time 0 until a time.
    double roll_moment_n_m = 0, roll_moment_until_s = 0;
    // Sideways velocity that all bodies are given at time 0.
    double sideways_kick_m_s = 0;
    ForceHistory force;
    // Where the force acts: from the centre of gravity in x and y, height above the road in z.
    chrono::ChVector3d point_m{0, 0, 0};
    Brakes brakes;
    EngineDrag engine;
    SteerHistory steer;
    StepInputs inputs;

    static Motion read(const std::string& path);
};

inline Motion Motion::read(const std::string& path) {
    const auto document = json::read(path);
    Motion motion;
    motion.speed_m_s = json::number(document, "speed_m_s");
    motion.friction = json::number(document, "friction");
    motion.longest_s = json::number_or(document, "longest_s", motion.longest_s);
    motion.step_s = json::number_or(document, "step_s", motion.step_s);
    motion.output_interval_s = json::number_or(document, "output_interval_s", motion.output_interval_s);
    motion.run_in_s = json::number_or(document, "run_in_s", motion.run_in_s);
    motion.stop_at_rest = json::flag_or(document, "stop_at_rest", motion.stop_at_rest);
    motion.hold_speed = json::flag_or(document, "hold_speed", motion.hold_speed);
    motion.roll_moment_n_m = json::number_or(document, "roll_moment_n_m", 0);
    motion.roll_moment_until_s = json::number_or(document, "roll_moment_until_s", 0);
    motion.sideways_kick_m_s = json::number_or(document, "sideways_kick_m_s", 0);
    if (json::has(document, "force")) {
        motion.force = ForceHistory::read(document["force"]);
        motion.point_m = json::vector(document["force"], "point_m");
    }
    if (json::has(document, "brakes")) {
        const auto& brakes = document["brakes"];
        motion.brakes.start_s = json::number(brakes, "start_s");
        motion.brakes.rise_s = json::number(brakes, "rise_s");
        const auto torque_n_m = json::numbers(brakes, "torque_n_m", 4);
        std::copy(torque_n_m.begin(), torque_n_m.end(), motion.brakes.torque_n_m.begin());
    }
    if (json::has(document, "engine")) {
        motion.engine.axle = json::number(document["engine"], "axle") < 0.5 ? 0 : 1;
        motion.engine.torque_n_m = json::number(document["engine"], "torque_n_m");
    }
    if (json::has(document, "steer")) {
        motion.steer.time_s = json::numbers(document["steer"], "time_s");
        motion.steer.angle_rad = json::numbers(document["steer"], "angle_rad", motion.steer.time_s.size());
    }
    return motion;
}
