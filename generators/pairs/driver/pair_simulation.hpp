// Two cars on one road, step by step. The contact force is that of the places at the start of a step and
// acts, equal and opposite, on both bodies at one height.
#pragma once

#include "pair_record.hpp"

// Force from which on the cars are in contact, and interruptions that are part of an interval.
constexpr double kContactForceN = 100, kInterruptionS = 0.03;

struct Interval {
    double start_s, end_s, impulse_x_n_s = 0, impulse_y_n_s = 0, moment_n_m_s = 0, peak_n = 0;
};

struct FirstContact {
    double time_s;
    // Where the struck car is touched, its axes; velocity of the striking car against it, axes of the road.
    Point on_struck, closing_m_s;
    double heading_rad;
};

struct PairOutcome {
    bool diverged = false, rolled_over = false, linkage_folded = false, at_rest = false;
    std::optional<FirstContact> first;
    std::vector<Interval> intervals;
    // Smallest distance of the outlines before first contact.
    double least_gap_before_m = 1e9;
    double height_m = 0;
    // Over all steps: what both contact works sum to at most (a gain), and the moment about the origin of the
    // road that both forces leave over.
    double largest_contact_gain_j = 0, contact_moment_left_n_m_s = 0;
};

class PairSimulation {
  public:
    explicit PairSimulation(const PairRequest& request)
        : m_request(request),
          m_struck(request.struck, request.friction, request.step_s, request.contact_height_m),
          m_striking(request.striking, request.friction, request.step_s, request.contact_height_m),
          m_contact(Outline(request.struck.shape, request.struck.law),
                    Outline(request.striking.shape, request.striking.law), request.elastic_n_m2,
                    request.contact_friction),
          m_struck_control(request.struck_driver, request.struck.speed_m_s, request.friction,
                           request.step_s),
          m_striking_control(request.striking_driver, request.side, request.heading_rad,
                             request.striking.speed_m_s, request.step_s),
          m_is_placed(!request.place_m) {
        m_struck.place(0, 0, 0);
        m_striking.place(request.x_m, request.y_m, request.heading_rad);
        m_outcome.height_m = request.contact_height_m;
    }

    const PairOutcome& outcome() const { return m_outcome; }
    PlacedCar& struck() { return m_struck; }
    PlacedCar& striking() { return m_striking; }
    const Contact& contact() const { return m_contact; }
    const std::vector<PairRow>& rows() const { return m_rows; }
    const std::vector<ContactRow>& contact_rows() const { return m_contact_rows; }

    void drive() {
        const long steps_per_row = std::lround(kRowS / m_request.step_s);
        const long n_steps = std::lround(m_request.longest_s / m_request.step_s);
        for (long step = 0; step < n_steps; step++) {
            const double time_s = step * m_request.step_s;
            if (!m_is_placed) {
                place(time_s);
                if (time_s > kLongestApproachS)
                    return;
            }
            ContactForce force;
            m_gap_m = m_contact.least_gap_m(m_struck.motion_in_plan(), m_striking.motion_in_plan());
            if (m_is_placed && m_gap_m < kNearM)
                force = m_contact.press(m_struck.motion_in_plan(), m_striking.motion_in_plan());
            note_contact(time_s, force);
            advance(step, steps_per_row, time_s, force);
            if (ends())
                return;
        }
    }

  private:
    static constexpr double kRowS = 0.01, kContactRowS = 1e-3;
    // A striking car that has not come across by then meets nobody.
    static constexpr double kLongestApproachS = 3.0;
    static constexpr double kNearM = 0.01;
    // The striking car is placed when its nearest corner is that far from the flank, and so that the outlines
    // are that far apart.
    static constexpr double kPlacingM = 0.05, kPlacedGapM = 0.004;
    // A front wheel so far off what is steered: the linkage of a solid axle has folded over.
    static constexpr double kFoldedRad = 0.2618;
    static constexpr double kStandstillS = 0.2;

    // Moves the striking car along x as soon as it has come across, so that it touches where it should.
    void place(double time_s) {
        const PlanarMotion& struck = m_struck.motion_in_plan();
        PlanarMotion striking = m_striking.motion_in_plan();
        const Outline& outline = m_contact.striking();
        Point corner;
        double nearest_m = -1e9;
        for (int i = 0; i < outline.size(); i++) {
            const Point turned = striking.turned_to_road(outline.at(i));
            if (m_request.side * turned.y > nearest_m) {
                nearest_m = m_request.side * turned.y;
                corner = turned;
            }
        }
        const double apart_m = m_request.side * (struck.y_m - striking.y_m) - nearest_m;
        if (time_s < kLeastApproachS || apart_m > m_request.struck.shape.width_m / 2 + kPlacingM)
            return;
        const double before_m = striking.x_m;
        striking.x_m =
            struck.x_m - m_request.struck.shape.cg_to_rear_axle_m + *m_request.place_m - corner.x;
        if (m_contact.gap_m(struck, striking) >= kPlacedGapM)
            return;
        const double shift_m = striking.x_m - before_m;
        m_striking.move_along_x(shift_m);
        m_is_placed = true;
        for (PairRow& row : m_rows) {
            row.striking.x_m += shift_m;
            const auto plan = [](const CarState& of) { return PlanarMotion{of.x_m, of.y_m, of.yaw_rad}; };
            row.gap_m = m_contact.gap_m(plan(row.struck), plan(row.striking));
            m_outcome.least_gap_before_m = std::min(m_outcome.least_gap_before_m, row.gap_m);
        }
    }

    void note_contact(double time_s, const ContactForce& force) {
        const double step_s = m_request.step_s;
        auto& intervals = m_outcome.intervals;
        if (force.sum_n > kContactForceN) {
            if (!m_outcome.first)
                m_outcome.first = first_contact(time_s, force);
            const bool goes_on = !intervals.empty() && time_s - intervals.back().end_s < kInterruptionS;
            if (!goes_on)
                intervals.push_back({time_s, time_s});
            intervals.back().end_s = time_s + step_s;
        }
        if (intervals.empty() || force.sum_n <= 0)
            return;
        intervals.back().impulse_x_n_s += force.x_n * step_s;
        intervals.back().impulse_y_n_s += force.y_n * step_s;
        intervals.back().moment_n_m_s += force.struck_moment_n_m * step_s;
        intervals.back().peak_n = std::max(intervals.back().peak_n, force.size_n());
    }

    FirstContact first_contact(double time_s, const ContactForce& force) const {
        const CarState& struck = m_struck.state();
        const PlanarMotion one = m_struck.motion_in_plan(), two = m_striking.motion_in_plan();
        return {time_s, on_car(struck, force.at_m), {two.vx_m_s - one.vx_m_s, two.vy_m_s - one.vy_m_s},
                m_striking.state().yaw_rad - struck.yaw_rad};
    }

    static Point on_car(const CarState& car, const Point& road) {
        return PlanarMotion{car.x_m, car.y_m, car.yaw_rad}.from_road(road);
    }

    void advance(long step, long steps_per_row, double time_s, const ContactForce& force) {
        const double since_s = m_outcome.first ? time_s - m_outcome.first->time_s : kBeforeContactS;
        const Controls of_struck = m_struck_control.at(m_struck, since_s);
        const Controls of_striking = m_striking_control.at(m_striking, time_s, since_s);
        if (step % steps_per_row == 0)
            m_rows.push_back({time_s, m_struck.state(), m_striking.state(), 0, 0, 0, shown_gap_m(), of_struck,
                              of_striking, m_struck_control.stability_control_acts()});
        const double share = 1.0 / steps_per_row;
        m_rows.back().force_x_n += force.x_n * share;
        m_rows.back().force_y_n += force.y_n * share;
        m_rows.back().moment_n_m += force.struck_moment_n_m * share;
        record_contact(step, time_s, force);
        balance(force);
        m_struck.advance(time_s, of_struck, force.x_n, force.y_n, force.struck_moment_n_m);
        m_striking.advance(time_s, of_striking, -force.x_n, -force.y_n, force.striking_moment_n_m);
        m_outcome.largest_contact_gain_j = std::max(
            m_outcome.largest_contact_gain_j, m_struck.contact_work_j() + m_striking.contact_work_j());
        m_folded = has_folded(m_struck, of_struck) || has_folded(m_striking, of_striking);
        const bool rest = m_struck.state().is_at_rest() && m_striking.state().is_at_rest();
        m_rest_s = rest ? m_rest_s + m_request.step_s : 0;
    }

    double shown_gap_m() const {
        if (m_gap_m >= 1 || !m_is_placed)
            return m_gap_m;
        return m_contact.gap_m(m_struck.motion_in_plan(), m_striking.motion_in_plan());
    }

    // Means of a millisecond; the point is weighted with the force.
    void record_contact(long step, double time_s, const ContactForce& force) {
        const long steps_per_row = std::max(1L, std::lround(kContactRowS / m_request.step_s));
        if (step % steps_per_row == 0 || m_weight_n == 0) {
            flush_contact();
            m_row = {};
            m_row.time_s = (step - step % steps_per_row) * m_request.step_s;
        }
        if (force.sum_n > 0) {
            const double share = 1.0 / steps_per_row, weight = force.sum_n;
            m_row.interval = static_cast<int>(m_outcome.intervals.size());
            m_row.x_n += share * force.x_n;
            m_row.y_n += share * force.y_n;
            m_row.struck_moment_n_m += share * force.struck_moment_n_m;
            m_row.striking_moment_n_m += share * force.striking_moment_n_m;
            const Point one = on_car(m_struck.state(), force.at_m);
            const Point two = on_car(m_striking.state(), force.at_m);
            m_row.on_struck = {m_row.on_struck.x + weight * one.x, m_row.on_struck.y + weight * one.y};
            m_row.on_striking = {m_row.on_striking.x + weight * two.x, m_row.on_striking.y + weight * two.y};
            m_weight_n += weight;
        }
        if (step % steps_per_row == steps_per_row - 1)
            flush_contact();
    }

    void flush_contact() {
        if (m_weight_n > 0 && m_row.interval > 0) {
            const auto mean = [&](const Point& sum) { return Point{sum.x / m_weight_n, sum.y / m_weight_n}; };
            m_row.on_struck = mean(m_row.on_struck);
            m_row.on_striking = mean(m_row.on_striking);
            m_contact_rows.push_back(m_row);
        }
        m_weight_n = 0;
    }

    // Both forces and moments about the origin of the road: they cancel.
    void balance(const ContactForce& force) {
        const PlanarMotion& one = m_struck.motion_in_plan();
        const PlanarMotion& two = m_striking.motion_in_plan();
        const double x_m = one.x_m - two.x_m, y_m = one.y_m - two.y_m;
        const double left = x_m * force.y_n - y_m * force.x_n + force.struck_moment_n_m +
                            force.striking_moment_n_m;
        m_outcome.contact_moment_left_n_m_s += std::abs(left) * m_request.step_s;
    }

    static bool has_folded(const PlacedCar& car, const Controls& controls) {
        const auto& angle_rad = car.state().front_angle_rad;
        return std::abs(angle_rad[0] - controls.steer_rad) > kFoldedRad ||
               std::abs(angle_rad[1] - controls.steer_rad) > kFoldedRad;
    }

    bool ends() {
        for (const PlacedCar* car : {&m_struck, &m_striking}) {
            const CarState& state = car->state();
            m_outcome.diverged |= !std::isfinite(state.x_m) || std::abs(state.pitch_rad) > kLargestPitchRad;
            m_outcome.rolled_over |= std::abs(state.roll_rad) > kRollOverRad;
        }
        m_outcome.linkage_folded = m_folded;
        m_outcome.at_rest = m_rest_s > kStandstillS;
        return m_outcome.diverged || m_outcome.rolled_over || m_outcome.linkage_folded || m_outcome.at_rest;
    }

    static constexpr double kLeastApproachS = 0.02;

    const PairRequest& m_request;
    PlacedCar m_struck, m_striking;
    Contact m_contact;
    StruckCarControl m_struck_control;
    StrikingCarControl m_striking_control;
    bool m_is_placed, m_folded = false;
    double m_gap_m = 1e9, m_rest_s = 0, m_weight_n = 0;
    ContactRow m_row;
    std::vector<PairRow> m_rows;
    std::vector<ContactRow> m_contact_rows;
    PairOutcome m_outcome;
};
