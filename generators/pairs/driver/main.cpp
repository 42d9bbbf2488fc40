// drive_pair: two cars of drive_car that touch and push each other, from before the contact to rest.
//
//   drive_pair PAIR.json MOTIONS.csv CONTACT.csv RESULT.json
//
// request.hpp says what PAIR.json holds. Exit status 1: the reason is on standard error.
#include <iostream>

#include "pair_simulation.hpp"

static void write_car(json::Writer& result, const char* name, PlacedCar& car, double largest_dent_m) {
    Balances& balances = car.balances();
    const std::string word = name;
    const auto number = [&](const char* what, double value) {
        result.number((word + "_" + what).c_str(), value);
    };
    number("start_energy_j", balances.start_energy_j());
    number("end_energy_j", balances.end_energy_j());
    number("energy_residual_j", balances.energy_residual_j());
    number("work_of_outer_forces_j", balances.works().outer_forces_j);
    number("contact_work_j", car.contact_work_j());
    number("momentum_residual_n_s", balances.momentum_residual_n_s());
    number("crush_m", largest_dent_m);
}

static void write_result(PairSimulation& simulation, const std::string& path) {
    const PairOutcome& outcome = simulation.outcome();
    json::Writer result;
    result.flag("diverged", outcome.diverged);
    result.flag("rolled_over", outcome.rolled_over);
    result.flag("linkage_folded", outcome.linkage_folded);
    result.flag("at_rest", outcome.at_rest);
    result.flag("touched", outcome.first.has_value());
    if (outcome.first) {
        const FirstContact& first = *outcome.first;
        result.number("first_contact_s", first.time_s);
        result.numbers("contact_m", {first.on_struck.x, first.on_struck.y, outcome.height_m});
        result.numbers("closing_m_s", {first.closing_m_s.x, first.closing_m_s.y});
        result.number("heading_rad", first.heading_rad);
    }
    result.number("least_gap_before_m", outcome.least_gap_before_m);
    result.number("largest_contact_gain_j", outcome.largest_contact_gain_j);
    result.number("contact_moment_left_n_m_s", outcome.contact_moment_left_n_m_s);
    write_car(result, "struck", simulation.struck(), simulation.contact().struck().largest_dent_m());
    write_car(result, "striking", simulation.striking(), simulation.contact().striking().largest_dent_m());
    result.begin_list("intervals");
    for (const Interval& interval : outcome.intervals) {
        result.begin_object();
        result.number("start_s", interval.start_s);
        result.number("end_s", interval.end_s);
        result.numbers("impulse_n_s", {interval.impulse_x_n_s, interval.impulse_y_n_s});
        result.number("moment_n_m_s", interval.moment_n_m_s);
        result.number("peak_n", interval.peak_n);
        result.end_object();
    }
    result.end_list();
    result.save(path);
}

int main(int n_arguments, char** arguments) {
    // The library reports every file that it reads.
    std::streambuf* output = std::cout.rdbuf(nullptr);
    int status = 0;
    try {
        if (n_arguments != 5)
            throw std::runtime_error("usage: drive_pair PAIR.json MOTIONS.csv CONTACT.csv RESULT.json");
        const PairRequest request = PairRequest::read(arguments[1]);
        PairSimulation simulation(request);
        simulation.drive();
        write_motions(simulation.rows(), arguments[2]);
        write_contact(simulation.contact_rows(), arguments[3]);
        write_result(simulation, arguments[4]);
    } catch (const std::exception& error) {
        std::cerr << error.what() << std::endl;
        status = 1;
    }
    std::cout.rdbuf(output);
    return status;
}
