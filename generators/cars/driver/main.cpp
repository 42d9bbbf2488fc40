// drive_car: motion of a car after an impact, put together from subsystems of Chrono::Vehicle.
//
//   drive_car tune CAR.json RESULT.json                       spring preloads that hold the car level
//   drive_car inspect CAR.json RESULT.json                    mass, inertia, wheel loads as it rolls
//   drive_car steering CAR.json RESULT.json                   angle of the front wheels over the steering
//   input drive_car drive CAR.json MOTION.json RECORD.csv RESULT.json
//
// car_description.hpp and motion.hpp say what the files hold. Exit status 1: the reason is on standard error.
#include <cstring>
#include <iostream>

#include "preparation.hpp"

static void write_outcome(const Outcome& outcome, const std::string& path) {
    json::Writer result;
    result.number("n_rows", outcome.n_rows);
    result.numbers("impulse_n_s", {outcome.impulse_n_s.x_n, outcome.impulse_n_s.y_n});
    result.number("start_energy_j", outcome.start_energy_j);
    result.number("end_energy_j", outcome.end_energy_j);
    result.number("work_of_outer_forces_j", outcome.works.outer_forces_j);
    result.number("work_of_tires_j", outcome.works.tires_j);
    result.number("work_of_gravity_j", outcome.works.gravity_j);
    result.number("work_of_springs_and_dampers_j", outcome.works.springs_and_dampers_j);
    result.number("work_of_brakes_j", outcome.works.brakes_j);
    result.number("work_of_anti_roll_bars_j", outcome.works.anti_roll_bars_j);
    result.number("work_of_steering_j", outcome.works.steering_j);
    result.number("energy_residual_j", outcome.energy_residual_j);
    result.number("momentum_residual_n_s", outcome.momentum_residual_n_s);
    result.flag("diverged", outcome.diverged);
    result.flag("rolled_over", outcome.rolled_over);
    result.flag("at_rest", outcome.at_rest);
    result.save(path);
}

static void run(const std::vector<std::string>& arguments) {
    if (arguments.size() < 3)
        throw std::runtime_error(
            "usage: drive_car tune|inspect|steering CAR.json RESULT.json, or drive_car drive "
            "CAR.json MOTION.json RECORD.csv RESULT.json");
    const std::string& command = arguments[0];
    const CarDescription description = CarDescription::read(arguments[1]);
    const BodyMass body = solve_body(description);
    if (command == "tune")
        tune(description, body, arguments[2]);
    else if (command == "inspect")
        inspect(description, body, arguments[2]);
    else if (command == "steering")
        steering(description, body, arguments[2]);
    else if (command == "drive" && arguments.size() == 5) {
        const Motion motion = Motion::read(arguments[2]);
        Simulation simulation(description, body, motion);
        write_outcome(simulation.drive(arguments[3]), arguments[4]);
    } else
        throw std::runtime_error("there is no command " + command + " with these arguments");
}

int main(int n_arguments, char** arguments) {
    // The library reports every file that it reads.
    std::streambuf* output = std::cout.rdbuf(nullptr);
    int status = 0;
    try {
        run(std::vector<std::string>(arguments + 1, arguments + n_arguments));
    } catch (const std::exception& error) {
        std::cerr << error.what() << std::endl;
        status = 1;
    }
    std::cout.rdbuf(output);
    return status;
}
