// A car as it is described to the driver: subsystems of Chrono's templates, the mass properties of the WHOLE
// car, springs, dampers, anti-roll bars, wheels and tires. SI units; x forward, y left, z up.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "json.hpp"

// A value of the tire at its nominal load and at twice that load.
struct AtLoads {
    double nominal = 0, twice = 0;
};

// Table of a tire in the form of TMeasy; forces at the friction of the table.
struct TireTable {
    double nominal_load_n, largest_load_n;
    double unloaded_radius_m, width_m, rim_radius_m;
    double vertical_stiffness_n_m, vertical_damping_n_s_m;
    AtLoads longitudinal_stiffness_n, longitudinal_peak_n, longitudinal_sliding_n, longitudinal_peak_slip;
    double longitudinal_sliding_slip;
    AtLoads lateral_stiffness_n, lateral_peak_n, lateral_sliding_n, lateral_peak_slip;
    double lateral_sliding_slip;
    AtLoads trail_over_contact_length, zero_trail_slip;
    double friction_of_table;
};

// Stiffness and damping of the carcass of every tire, along and across the wheel.
struct Carcass {
    double longitudinal_stiffness_n_m, lateral_stiffness_n_m;
    double longitudinal_damping_n_s_m, lateral_damping_n_s_m;
};

// A subsystem of Chrono: the name of its template, its file and its place in the chassis.
struct Subsystem {
    std::string template_name, file;
    chrono::ChVector3d location_m;
};

struct AxleDescription {
    Subsystem suspension;
    // Linear about the design length, three times as stiff beyond the free travel.
    double spring_stiffness_n_m, spring_preload_n, spring_free_travel_m;
    // Degressive: c v / (1 + d |v|).
    double damping_n_s_m, degressivity_s_m;
    // Vertical force between the wheel centres over the difference of their travel.
    double anti_roll_bar_n_m;
    double wheel_mass_kg, wheel_cross_inertia_kg_m2, wheel_spin_inertia_kg_m2;
    // With which a wheel starts to turn.
    double rolling_radius_m;
    TireTable tire;
};

// Mean angle of the front wheels over the input of the steering, which goes from -1 to 1.
struct SteeringTable {
    std::vector<double> input, angle_rad;

    bool is_known() const { return input.size() > 1; }

    // The input that turns the front wheels to this angle; the ends of the table hold beyond it.
    double input_at(double angle) const {
        if (angle <= angle_rad.front())
            return input.front();
        for (size_t i = 1; i < input.size(); i++)
            if (angle <= angle_rad[i]) {
                const double share = (angle - angle_rad[i - 1]) / (angle_rad[i] - angle_rad[i - 1]);
                return input[i - 1] + share * (input[i] - input[i - 1]);
            }
        return input.back();
    }
};

struct CarDescription {
    std::string name;
    double wheelbase_m, mass_kg, cg_to_front_axle_m, cg_height_m;
    // Height of the chassis frame, which lies at the front axle, at rest.
    double design_height_m;
    // Of the whole car about its centre of gravity; the product is the integral of x z dm.
    double roll_inertia_kg_m2, pitch_inertia_kg_m2, yaw_inertia_kg_m2, roll_yaw_product_kg_m2;
    double drag_area_m2;
    // Load of a wheel at which `friction` of a road is the peak lateral coefficient.
    double reference_load_n;
    double rolling_resistance;
    Carcass carcass;
    Subsystem steering;
    SteeringTable steering_table;
    std::array<AxleDescription, 2> axles;

    static CarDescription read(const std::string& path);
};

namespace car_description_detail {

inline AtLoads at_loads(const json::Value& object, const char* key) {
    const auto pair = json::numbers(object, key, 2);
    return {pair[0], pair[1]};
}

inline TireTable tire(const json::Value& object) {
    TireTable tire;
    tire.nominal_load_n = json::number(object, "nominal_load_n");
    tire.largest_load_n = json::number(object, "largest_load_n");
    tire.unloaded_radius_m = json::number(object, "unloaded_radius_m");
    tire.width_m = json::number(object, "width_m");
    tire.rim_radius_m = json::number(object, "rim_radius_m");
    tire.vertical_stiffness_n_m = json::number(object, "vertical_stiffness_n_m");
    tire.vertical_damping_n_s_m = json::number(object, "vertical_damping_n_s_m");
    tire.longitudinal_stiffness_n = at_loads(object, "longitudinal_stiffness_n");
    tire.longitudinal_peak_n = at_loads(object, "longitudinal_peak_n");
    tire.longitudinal_sliding_n = at_loads(object, "longitudinal_sliding_n");
    tire.longitudinal_peak_slip = at_loads(object, "longitudinal_peak_slip");
    tire.longitudinal_sliding_slip = json::number(object, "longitudinal_sliding_slip");
    tire.lateral_stiffness_n = at_loads(object, "lateral_stiffness_n");
    tire.lateral_peak_n = at_loads(object, "lateral_peak_n");
    tire.lateral_sliding_n = at_loads(object, "lateral_sliding_n");
    tire.lateral_peak_slip = at_loads(object, "lateral_peak_slip");
    tire.lateral_sliding_slip = json::number(object, "lateral_sliding_slip");
    tire.trail_over_contact_length = at_loads(object, "trail_over_contact_length");
    tire.zero_trail_slip = at_loads(object, "zero_trail_slip");
    tire.friction_of_table = json::number(object, "friction_of_table");
    return tire;
}

inline Subsystem subsystem(const json::Value& object, const std::filesystem::path& folder) {
    return {json::text(object, "template"), (folder / json::text(object, "file")).string(),
            json::vector(object, "location_m")};
}

inline AxleDescription axle(const json::Value& object, const std::filesystem::path& folder) {
    AxleDescription axle;
    axle.suspension = subsystem(json::member(object, "suspension"), folder);
    axle.spring_stiffness_n_m = json::number(object, "spring_stiffness_n_m");
    axle.spring_preload_n = json::number(object, "spring_preload_n");
    axle.spring_free_travel_m = json::number(object, "spring_free_travel_m");
    axle.damping_n_s_m = json::number(object, "damping_n_s_m");
    axle.degressivity_s_m = json::number(object, "degressivity_s_m");
    axle.anti_roll_bar_n_m = json::number(object, "anti_roll_bar_n_m");
    axle.wheel_mass_kg = json::number(object, "wheel_mass_kg");
    axle.wheel_cross_inertia_kg_m2 = json::number(object, "wheel_cross_inertia_kg_m2");
    axle.wheel_spin_inertia_kg_m2 = json::number(object, "wheel_spin_inertia_kg_m2");
    axle.rolling_radius_m = json::number(object, "rolling_radius_m");
    axle.tire = tire(json::member(object, "tire"));
    return axle;
}

}  // namespace car_description_detail

inline CarDescription CarDescription::read(const std::string& path) {
    namespace detail = car_description_detail;
    const auto document = json::read(path);
    const auto folder = std::filesystem::path(path).parent_path();
    CarDescription car;
    car.name = json::text(document, "name");
    car.wheelbase_m = json::number(document, "wheelbase_m");
    car.mass_kg = json::number(document, "mass_kg");
    car.cg_to_front_axle_m = json::number(document, "cg_to_front_axle_m");
    car.cg_height_m = json::number(document, "cg_height_m");
    car.design_height_m = json::number(document, "design_height_m");
    car.roll_inertia_kg_m2 = json::number(document, "roll_inertia_kg_m2");
    car.pitch_inertia_kg_m2 = json::number(document, "pitch_inertia_kg_m2");
    car.yaw_inertia_kg_m2 = json::number(document, "yaw_inertia_kg_m2");
    car.roll_yaw_product_kg_m2 = json::number(document, "roll_yaw_product_kg_m2");
    car.drag_area_m2 = json::number(document, "drag_area_m2");
    car.reference_load_n = json::number(document, "reference_load_n");
    car.rolling_resistance = json::number(document, "rolling_resistance");
    const auto& carcass = json::member(document, "carcass");
    car.carcass = {
        json::number(carcass, "longitudinal_stiffness_n_m"), json::number(carcass, "lateral_stiffness_n_m"),
        json::number(carcass, "longitudinal_damping_n_s_m"), json::number(carcass, "lateral_damping_n_s_m")};
    car.steering = detail::subsystem(json::member(document, "steering"), folder);
    if (json::has(document, "steering_table")) {
        const auto& table = document["steering_table"];
        car.steering_table = {json::numbers(table, "input"), json::numbers(table, "angle_rad")};
    }
    const auto& axles = json::member(document, "axles");
    if (!axles.IsArray() || axles.Size() != 2)
        throw std::runtime_error("axles is not a list of two");
    for (int i = 0; i < 2; i++)
        car.axles[i] = detail::axle(axles[i], folder);
    return car;
}
