// The drivers of both cars, anti-lock brakes and stability control. Times count from the first contact; they
// are negative before it.
#pragma once

#include "placed_car.hpp"

constexpr double kBeforeContactS = -1;
// Share of the front axle in the force of the brakes, and how fast a driver presses them.
constexpr double kFrontBrakeShare = 0.62, kBrakeRiseS = 0.3;
// How fast a driver turns the front wheels, rad/s.
constexpr double kSteerRateRad_s = 0.70;

// What went in some steps ago.
class Delay {
  public:
    explicit Delay(double delay_s, double step_s)
        : m_values(std::max(1L, std::lround(delay_s / step_s)), 0.0) {}

    double put(double value) {
        std::swap(value, m_values[m_next]);
        m_next = (m_next + 1) % m_values.size();
        return value;
    }

  private:
    std::vector<double> m_values;
    size_t m_next = 0;
};

// Brakes that follow what is wanted at limited rates; with an anti-lock system they let go where a wheel
// slips.
class BrakeSystem {
  public:
    std::array<double, kWheels> follow(PlacedCar& car, const std::array<double, kWheels>& wanted_n_m,
                                       bool anti_lock, double step_s) {
        const bool acts = anti_lock && car.state().speed_m_s() > kLeastSpeedM_s;
        for (int wheel = 0; wheel < kWheels; wheel++) {
            const double slip = acts ? car.slip_ratio(wheel) : 0;
            if (slip < -kReleaseSlip)
                m_released[wheel] = true;
            if (slip > -kReapplySlip)
                m_released[wheel] = false;
            const double change = (m_released[wheel] ? 0 : wanted_n_m[wheel]) - m_torque_n_m[wheel];
            m_torque_n_m[wheel] += std::clamp(change, -kFallN_m_s * step_s, kRiseN_m_s * step_s);
        }
        return m_torque_n_m;
    }

  private:
    static constexpr double kReleaseSlip = 0.16, kReapplySlip = 0.07, kLeastSpeedM_s = 2.0;
    static constexpr double kRiseN_m_s = 9e3, kFallN_m_s = 25e3;

    std::array<double, kWheels> m_torque_n_m{0, 0, 0, 0};
    std::array<bool, kWheels> m_released{false, false, false, false};
};

// Torque of the brakes for a deceleration.
inline std::array<double, kWheels> brake_torques_n_m(const PlacedCar& car, double deceleration_g) {
    std::array<double, kWheels> torque_n_m;
    for (int wheel = 0; wheel < kWheels; wheel++) {
        const double share = 0.5 * (axle_of(wheel) == 0 ? kFrontBrakeShare : 1 - kFrontBrakeShare);
        torque_n_m[wheel] =
            share * deceleration_g * car.weight_n() * car.rolling_radius_m(axle_of(wheel));
    }
    return torque_n_m;
}

// Torque at each driven wheel that holds a speed.
inline double holding_torque_n_m(const PlacedCar& car, double speed_m_s) {
    constexpr double kAirDensityKg_m3 = 1.2, kGain_s = 1.5, kLeastG = -0.05, kLargestG = 0.30;
    constexpr double kPowerW_kg = 90, kLeastSpeedM_s = 5;
    const auto& of = car.description();
    const double forward_m_s = car.state().forward_m_s;
    const double resistance_n = 0.5 * kAirDensityKg_m3 * of.drag_area_m2 * forward_m_s * forward_m_s +
                                of.rolling_resistance * car.weight_n();
    const double more_n = std::clamp(kGain_s * of.mass_kg * (speed_m_s - forward_m_s),
                                     kLeastG * car.weight_n(), kLargestG * car.weight_n());
    const double power_n = kPowerW_kg * of.mass_kg / std::max(kLeastSpeedM_s, std::abs(forward_m_s));
    return 0.5 * std::min(resistance_n + more_n, power_n) * car.rolling_radius_m(car.request().driven_axle);
}

inline void turn_towards(double& steer_rad, double wanted_rad, double step_s) {
    const double most_rad = kSteerRateRad_s * step_s;
    steer_rad += std::clamp(wanted_rad - steer_rad, -most_rad, most_rad);
}

// Generic stability control: brakes the wheels of one side in proportion to the difference of the yaw rate
// from that of a linear car, and to sideslip beyond a few degrees. It knows the friction.
class StabilityControl {
  public:
    StabilityControl(double understeer_rad_s2_m, double friction)
        : m_understeer_rad_s2_m(understeer_rad_s2_m), m_friction(friction) {}

    bool is_active() const { return m_active; }

    std::array<double, kWheels> torques_n_m(const PlacedCar& car) {
        const CarState& state = car.state();
        const double speed_m_s = std::max(state.forward_m_s, 0.1);
        const double on_road = kShareOfFriction * m_friction * kGravityM_s2 / speed_m_s;
        const double linear = speed_m_s * state.front_mean_rad() /
                              (car.description().wheelbase_m + m_understeer_rad_s2_m * speed_m_s * speed_m_s);
        const double reference = std::clamp(linear, -on_road, on_road);
        const double sideslip_rad = std::atan2(state.left_m_s, speed_m_s);
        const double beyond_rad =
            sideslip_rad - std::clamp(sideslip_rad, -kFreeSideslipRad, kFreeSideslipRad);
        const double error = state.yaw_rate_rad_s - reference - kSideslipGain_1_s * beyond_rad;
        const bool may = state.forward_m_s > kLeastSpeedM_s && std::abs(sideslip_rad) < kLargestSideslipRad;
        if (may && std::abs(error) > kOnRad_s)
            m_active = true;
        if (!may || std::abs(error) < kOffRad_s)
            m_active = false;
        std::array<double, kWheels> torque_n_m{0, 0, 0, 0};
        if (!m_active)
            return torque_n_m;
        const double most_n_m = kLargestOverLoad * car.weight_n() * 0.5 * car.rolling_radius_m(0);
        const double wanted_n_m = kGainN_m_s * (std::abs(error) - kFreeRad_s) *
                                  car.description().mass_kg / kUsualMassKg;
        const double torque = std::min(most_n_m, wanted_n_m);
        const bool oversteers = std::abs(state.yaw_rate_rad_s) > std::abs(reference) ||
                                std::abs(beyond_rad) > kOversteerRad;
        // A car that turns too far to the left is braked on its right.
        const int side = error > 0 ? 1 : 0;
        torque_n_m[side] = (oversteers ? 1.0 : 0.3) * torque;
        torque_n_m[2 + side] = (oversteers ? 0.35 : 0.7) * torque;
        return torque_n_m;
    }

  private:
    static constexpr double kShareOfFriction = 0.85, kFreeSideslipRad = 0.07, kSideslipGain_1_s = 1.5;
    static constexpr double kOnRad_s = 0.10, kOffRad_s = 0.04, kFreeRad_s = 0.02, kOversteerRad = 0.03;
    static constexpr double kLeastSpeedM_s = 4.0, kLargestSideslipRad = 1.05;
    static constexpr double kGainN_m_s = 9000, kUsualMassKg = 1500, kLargestOverLoad = 1.3;

    double m_understeer_rad_s2_m, m_friction;
    bool m_active = false;
};

class StruckCarControl {
  public:
    StruckCarControl(const StruckDriver& driver, double speed_m_s, double friction, double step_s)
        : m_driver(driver),
          m_speed_m_s(speed_m_s),
          m_step_s(step_s),
          m_course_rad(driver.steer_delay_s, step_s),
          m_yaw_rate_rad_s(driver.steer_delay_s, step_s) {
        if (driver.control_understeer_rad_s2_m)
            m_stability.emplace(*driver.control_understeer_rad_s2_m, friction);
    }

    bool stability_control_acts() const { return m_stability && m_stability->is_active(); }

    Controls at(PlacedCar& car, double since_contact_s) {
        Controls controls;
        const bool reacts = since_contact_s > m_driver.reaction_s;
        const bool holds_on = m_driver.kind == "hold" && !reacts;
        if (since_contact_s < 0 || holds_on)
            controls.drive_n_m = holding_torque_n_m(car, m_speed_m_s);
        turn_towards(m_steer_rad, wanted_steer_rad(car, reacts), m_step_s);
        controls.steer_rad = m_steer_rad;
        std::array<double, kWheels> wanted_n_m{0, 0, 0, 0};
        if (m_driver.kind == "brake" && reacts) {
            const double pressed = std::min(1.0, (since_contact_s - m_driver.reaction_s) / kBrakeRiseS);
            wanted_n_m = brake_torques_n_m(car, pressed * m_driver.brake_g);
        }
        if (m_stability) {
            const auto of_system = m_stability->torques_n_m(car);
            for (int wheel = 0; wheel < kWheels; wheel++)
                wanted_n_m[wheel] = std::max(wanted_n_m[wheel], of_system[wheel]);
        }
        const bool anti_lock = m_driver.anti_lock || m_stability.has_value();
        controls.brake_n_m = m_brakes.follow(car, wanted_n_m, anti_lock, m_step_s);
        return controls;
    }

  private:
    static constexpr double kLargestCourseRad = 0.6, kLargestSteerRad = 0.42;

    // Towards where the front axle moves, less a share of the yaw rate, both seen with a delay.
    double wanted_steer_rad(const PlacedCar& car, bool reacts) {
        const CarState& state = car.state();
        const double left_m_s =
            state.left_m_s + car.description().cg_to_front_axle_m * state.yaw_rate_rad_s;
        const double course_rad = state.forward_m_s > 1 ? std::atan2(left_m_s, state.forward_m_s) : 0;
        const double seen_rad =
            m_course_rad.put(std::clamp(course_rad, -kLargestCourseRad, kLargestCourseRad));
        const double seen_rad_s = m_yaw_rate_rad_s.put(state.yaw_rate_rad_s);
        if (m_driver.kind != "counter" || !reacts)
            return 0;
        const double wanted_rad = m_driver.steer_gain * seen_rad - m_driver.steer_rate_gain_s * seen_rad_s;
        return std::clamp(wanted_rad, -kLargestSteerRad, kLargestSteerRad);
    }

    const StruckDriver& m_driver;
    double m_speed_m_s, m_step_s;
    Delay m_course_rad, m_yaw_rate_rad_s;
    std::optional<StabilityControl> m_stability;
    BrakeSystem m_brakes;
    double m_steer_rad = 0;
};

class StrikingCarControl {
  public:
    // `side`: sign of a turn towards the struck car.
    StrikingCarControl(const StrikingDriver& driver, double side, double heading_rad, double speed_m_s,
                       double step_s)
        : m_driver(driver),
          m_side(side),
          m_heading_rad(heading_rad),
          m_speed_m_s(speed_m_s),
          m_step_s(step_s),
          m_off_course(kDelayS, step_s) {}

    Controls at(PlacedCar& car, double time_s, double since_contact_s) {
        Controls controls;
        const double wanted_rad = wanted_steer_rad(car, time_s, since_contact_s);
        if (m_driver.steer_rad != 0 && since_contact_s < 0)
            m_steer_rad = wanted_rad;
        else
            turn_towards(m_steer_rad, wanted_rad, m_step_s);
        controls.steer_rad = m_steer_rad;
        const bool released =
            m_driver.kind != "push" && since_contact_s >= 0 && since_contact_s > m_driver.release_s;
        std::array<double, kWheels> wanted_n_m{0, 0, 0, 0};
        if (!released)
            controls.drive_n_m = holding_torque_n_m(car, m_speed_m_s);
        else if (m_driver.kind == "brake") {
            const double pressed = std::min(1.0, (since_contact_s - m_driver.release_s) / kBrakeRiseS);
            wanted_n_m = brake_torques_n_m(car, pressed * m_driver.brake_g);
        } else {
            const double radius_m = car.rolling_radius_m(car.request().driven_axle);
            controls.drive_n_m =
                -0.5 * kEngineDragG * car.weight_n() * radius_m * std::tanh(car.state().forward_m_s);
        }
        controls.brake_n_m = m_brakes.follow(car, wanted_n_m, true, m_step_s);
        return controls;
    }

  private:
    // Steering back to the old heading.
    static constexpr double kDelayS = 0.15, kYawRateGainS = 0.35, kLargestSteerRad = 0.35;
    static constexpr double kReactionS = 0.5, kEngineDragG = 0.04;

    double wanted_steer_rad(const PlacedCar& car, double time_s, double since_contact_s) {
        const CarState& state = car.state();
        const double off = state.yaw_rad - m_heading_rad + kYawRateGainS * state.yaw_rate_rad_s;
        const double seen = m_off_course.put(off);
        if (since_contact_s >= 0 && m_driver.away_rad > 0 && since_contact_s < m_driver.away_s)
            return -m_side * m_driver.away_rad;
        const bool steers = m_driver.steer_rad != 0;
        const double reacts_s = std::max(m_driver.steer_after_contact_s, steers ? 0.0 : kReactionS);
        if (since_contact_s >= 0 && since_contact_s >= reacts_s)
            return std::clamp(-seen, -kLargestSteerRad, kLargestSteerRad);
        return steers ? m_side * m_driver.steer_rad * turned_share(time_s) : 0;
    }

    double turned_share(double time_s) const {
        const double since_s = time_s - m_driver.steer_start_s, rise_s = m_driver.steer_rise_s;
        if (since_s <= 0)
            return 0;
        const double back_s = since_s - rise_s - m_driver.steer_hold_s;
        if (m_driver.straightens && back_s > 0)
            return back_s < rise_s ? 0.5 * (1 + std::cos(M_PI * back_s / rise_s)) : 0;
        return since_s < rise_s ? 0.5 * (1 - std::cos(M_PI * since_s / rise_s)) : 1;
    }

    const StrikingDriver& m_driver;
    double m_side, m_heading_rad, m_speed_m_s, m_step_s;
    Delay m_off_course;
    BrakeSystem m_brakes;
    double m_steer_rad = 0;
};
