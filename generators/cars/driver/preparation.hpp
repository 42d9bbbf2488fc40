// What is found on a car before it is driven: spring preloads, properties at rest, the table of its steering.
#pragma once

#include "simulation.hpp"

// Means of both sides of the axles, of a car that rolls slowly.
struct AtRest {
    std::array<double, 2> spring_force_n{0, 0}, spring_extension_m{0, 0}, wheel_load_n{0, 0};
};

inline Motion slow_roll(double speed_m_s, double run_in_s) {
    Motion motion;
    motion.speed_m_s = speed_m_s;
    motion.friction = 0.8;
    motion.step_s = 0.001;
    motion.run_in_s = run_in_s;
    return motion;
}

inline AtRest settle(const CarDescription& description, const BodyMass& body) {
    const Motion motion = slow_roll(5, 3);
    // Held at the centre of gravity of the body, the axles carry what they carry when the car rolls freely.
    Simulation simulation(description, body, motion, body.cg_m);
    simulation.run_in();
    AtRest rest;
    for (const auto& spring : simulation.car().springs()) {
        rest.spring_force_n[spring.axle] += 0.5 * spring.link->GetForce();
        rest.spring_extension_m[spring.axle] +=
            0.5 * (spring.link->GetLength() - spring.force->design_length_m());
    }
    for (int wheel = 0; wheel < kWheels; wheel++)
        rest.wheel_load_n[axle_of(wheel)] += 0.5 * simulation.car().corner(wheel).tire->state().load_n;
    return rest;
}

// Spring preloads that hold the car at its design height.
inline void tune(CarDescription description, const BodyMass& body, const std::string& result_file) {
    constexpr int kMostRounds = 5;
    constexpr double kExtensionM = 1e-4;
    AtRest rest;
    for (int round = 0; round < kMostRounds; round++) {
        rest = settle(description, body);
        for (int axle = 0; axle < 2; axle++)
            description.axles[axle].spring_preload_n = rest.spring_force_n[axle];
        const bool is_level = std::abs(rest.spring_extension_m[0]) < kExtensionM &&
                              std::abs(rest.spring_extension_m[1]) < kExtensionM;
        if (round > 0 && is_level)
            break;
    }
    json::Writer result;
    result.numbers("spring_preload_n", {rest.spring_force_n[0], rest.spring_force_n[1]});
    result.numbers("spring_extension_m", {rest.spring_extension_m[0], rest.spring_extension_m[1]});
    result.numbers("wheel_load_n", {rest.wheel_load_n[0], rest.wheel_load_n[1]});
    result.save(result_file);
}

// Mass properties, wheel positions and loads of the car as it rolls.
inline void inspect(const CarDescription& description, const BodyMass& body, const std::string& result_file) {
    const Motion motion = slow_roll(5, 3);
    Simulation simulation(description, body, motion);
    simulation.run_in();
    Car& car = simulation.car();
    const WholeCar whole = whole_car(simulation.system());
    const auto frame = car.GetChassisBody()->GetFrameRefToAbs();
    json::Writer result;
    result.number("mass_kg", whole.mass_kg);
    result.number("links_and_wheels_kg", whole.mass_kg - body.mass_kg);
    result.number("cg_height_m", whole.cg_m.z());
    result.number("cg_left_m", whole.cg_m.y() - frame.GetPos().y());
    result.number("roll_inertia_kg_m2", whole.inertia_kg_m2(0, 0));
    result.number("pitch_inertia_kg_m2", whole.inertia_kg_m2(1, 1));
    result.number("yaw_inertia_kg_m2", whole.inertia_kg_m2(2, 2));
    result.number("roll_yaw_product_kg_m2", -whole.inertia_kg_m2(0, 2));
    result.number("pitch_rad", -std::asin(frame.GetRotMat()(2, 0)));
    result.begin_list("wheels");
    for (int wheel = 0; wheel < kWheels; wheel++) {
        const auto& corner = car.corner(wheel);
        const auto position = corner.spindle->GetPos() - whole.cg_m;
        const auto axis = corner.spindle->GetRotMat().GetAxisY();
        result.begin_object();
        result.number("x_m", position.x());
        result.number("y_m", position.y());
        result.number("centre_height_m", corner.spindle->GetPos().z());
        result.number("load_n", corner.tire->state().load_n);
        result.number("toe_rad", -std::atan2(axis.x(), axis.y()));
        result.number("camber_rad", std::atan2(axis.z(), axis.y()));
        result.number("peak_coefficient", corner.tire->peak_coefficient());
        result.end_object();
    }
    result.end_list();
    result.save(result_file);
}

// Mean angle of the front wheels over the input, from the middle to one end, rolling slowly. It ends where
// the wheels are turned far enough or no further.
inline SteeringTable sweep(const CarDescription& description, const BodyMass& body, double direction) {
    constexpr double kSweepS = 4, kFarRad = 0.5;
    constexpr long kStepsPerPoint = 100;
    const Motion motion = slow_roll(2, 1);
    Simulation simulation(description, body, motion);
    simulation.run_in();
    SteeringTable table;
    for (long step = 0; step * motion.step_s <= kSweepS; step++) {
        const double input = direction * step * motion.step_s / kSweepS;
        simulation.set_steering_input(input);
        simulation.advance(step * motion.step_s, false);
        if (step % kStepsPerPoint != 0)
            continue;
        const double angle_rad = simulation.car().mean_front_angle_rad();
        const bool goes_on = table.input.empty() || direction * (angle_rad - table.angle_rad.back()) > 0;
        if (!goes_on)
            break;
        table.input.push_back(input);
        table.angle_rad.push_back(angle_rad);
        if (std::abs(angle_rad) > kFarRad)
            break;
    }
    return table;
}

inline void steering(const CarDescription& description, const BodyMass& body,
                     const std::string& result_file) {
    const SteeringTable left = sweep(description, body, 1), right = sweep(description, body, -1);
    SteeringTable table;
    for (size_t i = right.input.size(); i-- > 1;) {
        table.input.push_back(right.input[i]);
        table.angle_rad.push_back(right.angle_rad[i]);
    }
    // The middle is a point of both; a car whose steering is not symmetric has an angle there.
    table.input.insert(table.input.end(), left.input.begin(), left.input.end());
    table.angle_rad.insert(table.angle_rad.end(), left.angle_rad.begin(), left.angle_rad.end());
    json::Writer result;
    result.numbers("input", table.input);
    result.numbers("angle_rad", table.angle_rad);
    result.save(result_file);
}
