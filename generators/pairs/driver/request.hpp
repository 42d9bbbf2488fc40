// What a pair is asked to do: both cars, where they stand, what their drivers do, and their contact.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>

#include "outline.hpp"

// The driver of the struck car holds its speed until the first contact; times count from it.
struct StruckDriver {
    // "coast", "brake", "counter" (steers against the turn) or "hold" (keeps the throttle for a while).
    std::string kind;
    double reaction_s = 0, brake_g = 0, steer_gain = 0, steer_rate_gain_s = 0, steer_delay_s = 0;
    bool anti_lock = true;
    // With which yaw rate over steering stability control reckons, rad s2/m; none without the system.
    std::optional<double> control_understeer_rad_s2_m;
};

// The driver of the striking car turns his steering wheel, holds it, and steers back to his old heading.
struct StrikingDriver {
    // "push" (holds the speed), "brake" or "lift"; the latter two from `release_s` after first contact.
    std::string kind;
    double release_s = 0, brake_g = 0;
    // Angle of the front wheels towards the struck car; 0 for one who does not steer.
    double steer_rad = 0, steer_start_s = 0, steer_rise_s = 0, steer_hold_s = 0;
    bool straightens = false;
    double steer_after_contact_s = 0;
    // The opposite angle after first contact, and for how long.
    double away_rad = 0, away_s = 0;
};

struct CarRequest {
    std::string car_file;
    double speed_m_s = 0;
    int driven_axle = 1;
    BodyShape shape;
    CrushLaw law;

    // The description of the car is told from the folder of the request.
    static CarRequest read(const json::Value& object, const std::filesystem::path& folder) {
        return {(folder / json::text(object, "car")).string(), json::number(object, "speed_m_s"),
                json::number(object, "driven_axle") < 0.5 ? 0 : 1,
                BodyShape::read(json::member(object, "shape")), CrushLaw::read(json::member(object, "law"))};
    }
};

struct PairRequest {
    CarRequest struck, striking;
    StruckDriver struck_driver;
    StrikingDriver striking_driver;
    double friction = 0.8, longest_s = 8, step_s = 5e-4;
    // +1 with the striking car on the right of the struck one, which stands at the origin along x.
    double side = 1;
    double x_m = 0, y_m = 0, heading_rad = 0;
    // Where the struck car shall be touched, ahead of its rear axle: the striking car is moved along x to
    // meet it as soon as it has come across.
    std::optional<double> place_m;
    double contact_height_m = 0.5, contact_friction = 0.3, elastic_n_m2 = 9e6;

    static PairRequest read(const std::string& path);
};

inline std::string one_of(const json::Value& object, const char* key,
                          std::initializer_list<const char*> names) {
    const std::string name = json::text(object, key);
    for (const char* known : names)
        if (name == known)
            return name;
    throw std::runtime_error(std::string(key) + ": there is no " + name);
}

inline StruckDriver read_struck_driver(const json::Value& object) {
    StruckDriver driver;
    driver.kind = one_of(object, "kind", {"coast", "brake", "counter", "hold"});
    driver.reaction_s = json::number_or(object, "reaction_s", 0);
    driver.brake_g = json::number_or(object, "brake_g", 0);
    driver.steer_gain = json::number_or(object, "steer_gain", 0);
    driver.steer_rate_gain_s = json::number_or(object, "steer_rate_gain_s", 0);
    driver.steer_delay_s = json::number_or(object, "steer_delay_s", 0);
    driver.anti_lock = json::flag_or(object, "anti_lock", true);
    if (json::has(object, "control_understeer_rad_s2_m"))
        driver.control_understeer_rad_s2_m = json::number(object, "control_understeer_rad_s2_m");
    return driver;
}

inline StrikingDriver read_striking_driver(const json::Value& object) {
    StrikingDriver driver;
    driver.kind = one_of(object, "kind", {"push", "brake", "lift"});
    driver.release_s = json::number_or(object, "release_s", 0);
    driver.brake_g = json::number_or(object, "brake_g", 0);
    driver.steer_rad = json::number_or(object, "steer_rad", 0);
    driver.steer_start_s = json::number_or(object, "steer_start_s", 0);
    driver.steer_rise_s = json::number_or(object, "steer_rise_s", 0);
    driver.steer_hold_s = json::number_or(object, "steer_hold_s", 0);
    driver.straightens = json::flag_or(object, "straightens", false);
    driver.steer_after_contact_s = json::number_or(object, "steer_after_contact_s", 0);
    driver.away_rad = json::number_or(object, "away_rad", 0);
    driver.away_s = json::number_or(object, "away_s", 0);
    return driver;
}

inline PairRequest PairRequest::read(const std::string& path) {
    const auto document = json::read(path);
    const auto& struck = json::member(document, "struck");
    const auto& striking = json::member(document, "striking");
    const auto& contact = json::member(document, "contact");
    const auto folder = std::filesystem::path(path).parent_path();
    PairRequest request{CarRequest::read(struck, folder), CarRequest::read(striking, folder),
                        read_struck_driver(json::member(struck, "driver")),
                        read_striking_driver(json::member(striking, "driver"))};
    request.friction = json::number(document, "friction");
    request.longest_s = json::number_or(document, "longest_s", request.longest_s);
    request.step_s = json::number_or(document, "step_s", request.step_s);
    request.side = json::number(document, "side") < 0 ? -1 : 1;
    request.x_m = json::number(striking, "x_m");
    request.y_m = json::number(striking, "y_m");
    request.heading_rad = json::number_or(striking, "heading_rad", 0);
    if (json::has(document, "place_m"))
        request.place_m = json::number(document, "place_m");
    request.contact_height_m = json::number(contact, "height_m");
    request.contact_friction = json::number(contact, "friction");
    request.elastic_n_m2 = json::number(contact, "elastic_n_m2");
    return request;
}
