// Tire: the characteristic of TMeasy with its own force law, for any sideslip, standstill and rolling
// backwards.
//
//   slip         s = (-(v_x - R w), -v_y) / (|R w| + v_0)
//   steady force F(|s|) along s: rational up to the peak, cubic to sliding, constant beyond; peak and slip at
//                the peak are scaled with the friction of the road
//   deflection   first order: the carcass, a spring and a damper in x and y, is between the rim and the road
//
// The friction of the road is the peak lateral coefficient of the tire at the reference load of the car.
#pragma once

#include "car_description.hpp"
#include "chrono_vehicle/wheeled_vehicle/tire/ChTMeasyTire.h"

// What a tire does in a step, wheel axes: force of the road on the wheel.
struct TireState {
    double longitudinal_n = 0, lateral_n = 0, load_n = 0, slip_ratio = 0;
};

class Tire : public chrono::vehicle::ChTMeasyTire {
  public:
    Tire(const std::string& name, const CarDescription& car, int axle)
        : ChTMeasyTire(name), m_car(car), m_table(car.axles[axle].tire) {}

    const TireState& state() const { return m_state; }
    double peak_coefficient() const { return m_peak_coefficient; }

    // Mass and inertia of the tire are those of the wheel.
    double GetTireMass() const override { return 0; }
    chrono::ChVector3d GetTireInertia() const override { return chrono::ChVector3d(0, 0, 0); }

    void SetTMeasyParams() override {
        auto& to = m_par;
        to.pn = m_table.nominal_load_n;
        to.pn_max = m_table.largest_load_n;
        m_unloaded_radius = m_table.unloaded_radius_m;
        m_width = m_table.width_m;
        m_rim_radius = m_table.rim_radius_m;
        SetVerticalStiffness(m_table.vertical_stiffness_n_m);
        to.dz = m_table.vertical_damping_n_s_m;
        copy(m_table.longitudinal_stiffness_n, to.dfx0_pn, to.dfx0_p2n);
        copy(m_table.longitudinal_peak_n, to.fxm_pn, to.fxm_p2n);
        copy(m_table.longitudinal_sliding_n, to.fxs_pn, to.fxs_p2n);
        copy(m_table.longitudinal_peak_slip, to.sxm_pn, to.sxm_p2n);
        to.sxs_pn = to.sxs_p2n = m_table.longitudinal_sliding_slip;
        copy(m_table.lateral_stiffness_n, to.dfy0_pn, to.dfy0_p2n);
        copy(m_table.lateral_peak_n, to.fym_pn, to.fym_p2n);
        copy(m_table.lateral_sliding_n, to.fys_pn, to.fys_p2n);
        copy(m_table.lateral_peak_slip, to.sym_pn, to.sym_p2n);
        to.sys_pn = to.sys_p2n = m_table.lateral_sliding_slip;
        copy(m_table.trail_over_contact_length, to.nL0_pn, to.nL0_p2n);
        copy(m_table.zero_trail_slip, to.sq0_pn, to.sq0_p2n);
        copy(m_table.zero_trail_slip, to.sqe_pn, to.sqe_p2n);
        m_bottom_radius = m_table.rim_radius_m + 0.005;
        m_bottom_stiffness = 3 * m_d1;
        SetFrictionCoefficient(m_table.friction_of_table);
        SetRollingResistanceCoefficient(m_car.rolling_resistance);
        m_peak_coefficient = lateral_peak_n(m_car.reference_load_n) / m_car.reference_load_n;
    }

    void Synchronize(double time, const chrono::vehicle::ChTerrain& terrain) override {
        ChTMeasyTire::Synchronize(time, terrain);
        // The library scales by the friction of the road over that of the table.
        m_states.muscale *= m_par.mu_0 / m_peak_coefficient;
    }

    void Advance(double step_s) override {
        m_tireforce.force = chrono::ChVector3d(0, 0, 0);
        m_tireforce.moment = chrono::ChVector3d(0, 0, 0);
        m_state = TireState{};
        if (!m_data.in_contact) {
            m_deflection_x_m *= std::exp(-step_s / kRelaxationInAirS);
            m_deflection_y_m *= std::exp(-step_s / kRelaxationInAirS);
            return;
        }
        const double forward_m_s = m_data.vel.x(), sideways_m_s = m_data.vel.y();
        const double rolling_m_s = m_states.R_eff * m_states.omega;
        const double sliding_m_s = forward_m_s - rolling_m_s;
        const double transport_m_s = std::abs(rolling_m_s) + kRegularisationM_s;
        const double force_over_slip =
            force_over_slip_n(-sliding_m_s / transport_m_s, -sideways_m_s / transport_m_s);
        const auto& carcass = m_car.carcass;
        double longitudinal_n =
            carcass_force(m_deflection_x_m, step_s, force_over_slip, sliding_m_s, transport_m_s,
                          carcass.longitudinal_stiffness_n_m, carcass.longitudinal_damping_n_s_m);
        double lateral_n =
            carcass_force(m_deflection_y_m, step_s, force_over_slip, sideways_m_s, transport_m_s,
                          carcass.lateral_stiffness_n_m, carcass.lateral_damping_n_s_m);
        // The force of the carcass stays near the limit of friction.
        const double largest_n = 1.05 * m_states.muscale * std::hypot(m_states.fxm, m_states.fym) + 1.0;
        const double size_n = std::hypot(longitudinal_n, lateral_n);
        if (size_n > largest_n) {
            longitudinal_n *= largest_n / size_n;
            lateral_n *= largest_n / size_n;
        }
        const double overturning = -m_width * m_width * m_d1 / 12.0 * m_states.gamma;
        const double rolling_resistance =
            -m_rolling_resistance * m_data.normal_force * m_unloaded_radius * std::tanh(m_states.omega);
        const double aligning = AlignmentTorque(lateral_n) * std::tanh(forward_m_s);
        m_tireforce.force = chrono::ChVector3d(longitudinal_n, lateral_n, m_data.normal_force);
        m_tireforce.moment = chrono::ChVector3d(overturning, rolling_resistance, aligning);
        const double slip_ratio = -sliding_m_s / std::max(std::abs(forward_m_s), kLeastSpeedM_s);
        m_state = {longitudinal_n, lateral_n, m_data.normal_force, slip_ratio};
    }

  private:
    // Speed that keeps the slip finite at standstill, m/s.
    static constexpr double kRegularisationM_s = 0.05;
    // Speed under which the slip ratio is that at this speed, m/s.
    static constexpr double kLeastSpeedM_s = 0.5;
    // Time in which the carcass of a wheel in the air springs back, s.
    static constexpr double kRelaxationInAirS = 0.01;

    static void copy(const AtLoads& from, double& nominal, double& twice) {
        nominal = from.nominal;
        twice = from.twice;
    }

    // Peak lateral force of the table at a load, quadratic in the load.
    double lateral_peak_n(double load_n) const {
        const auto& peak = m_table.lateral_peak_n;
        const double share = load_n / m_table.nominal_load_n;
        return share * (2 * peak.nominal - 0.5 * peak.twice - (peak.nominal - 0.5 * peak.twice) * share);
    }

    // Size of the steady force over the size of the slip; stiffness, peak and sliding force lie between those
    // along and across the wheel by the direction of the slip.
    double force_over_slip_n(double slip_x, double slip_y) const {
        const double slip = std::hypot(slip_x, slip_y);
        const double along = slip > 1e-9 ? slip_x / slip : 1.0, across = slip > 1e-9 ? slip_y / slip : 0.0;
        const auto mixed = [&](double x, double y) { return std::hypot(x * along, y * across); };
        const double friction = m_states.muscale;
        const double peak_n = friction * mixed(m_states.fxm, m_states.fym);
        const double sliding_n = friction * mixed(m_states.fxs, m_states.fys);
        const double peak_slip = friction * mixed(m_states.sxm, m_states.sym);
        const double sliding_slip = mixed(m_states.sxs, m_states.sys);
        const double stiffness_n = std::max(mixed(m_states.dfx0, m_states.dfy0), 2 * peak_n / peak_slip);
        if (slip < peak_slip) {
            const double share = slip / peak_slip;
            return stiffness_n / (1 + share * (share + stiffness_n * peak_slip / peak_n - 2));
        }
        if (slip >= sliding_slip)
            return sliding_n / slip;
        const double share = (slip - peak_slip) / (sliding_slip - peak_slip);
        return (peak_n - (peak_n - sliding_n) * share * share * (3 - 2 * share)) / slip;
    }

    // Force of the carcass after a step, implicit in its deflection.
    static double carcass_force(double& deflection_m, double step_s, double force_over_slip_n,
                                double velocity_m_s, double transport_m_s, double stiffness_n_m,
                                double damping_n_s_m) {
        const double resistance = transport_m_s * damping_n_s_m + force_over_slip_n;
        const double after_m = (deflection_m - step_s * force_over_slip_n * velocity_m_s / resistance) /
                               (1 + step_s * transport_m_s * stiffness_n_m / resistance);
        const double force_n = stiffness_n_m * after_m + damping_n_s_m * (after_m - deflection_m) / step_s;
        deflection_m = after_m;
        return force_n;
    }

    const CarDescription& m_car;
    const TireTable& m_table;
    TireState m_state;
    double m_peak_coefficient = 1;
    double m_deflection_x_m = 0, m_deflection_y_m = 0;
};
