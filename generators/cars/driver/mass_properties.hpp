// Mass properties of the whole car, and the body that gives the car those of its description.
#pragma once

#include "car.hpp"

struct WholeCar {
    double mass_kg = 0;
    chrono::ChVector3d cg_m{0, 0, 0};
    chrono::ChMatrix33<> inertia_kg_m2;
};

struct Momentum {
    chrono::ChVector3d linear_n_s{0, 0, 0};
    double kinetic_energy_j = 0;
};

// Adds the inertia of a point mass at a distance (Steiner).
inline void add_point(chrono::ChMatrix33<>& inertia, double mass_kg, const chrono::ChVector3d& at) {
    const double x = at.x(), y = at.y(), z = at.z();
    inertia(0, 0) += mass_kg * (y * y + z * z);
    inertia(1, 1) += mass_kg * (x * x + z * z);
    inertia(2, 2) += mass_kg * (x * x + y * y);
    inertia(0, 1) -= mass_kg * x * y;
    inertia(1, 0) -= mass_kg * x * y;
    inertia(0, 2) -= mass_kg * x * z;
    inertia(2, 0) -= mass_kg * x * z;
    inertia(1, 2) -= mass_kg * y * z;
    inertia(2, 1) -= mass_kg * y * z;
}

// Inertia of a body in the axes of the world, about a point.
inline chrono::ChMatrix33<> inertia_about(chrono::ChBody& body, const chrono::ChVector3d& point) {
    const chrono::ChMatrix33<> rotation(body.GetRot());
    chrono::ChMatrix33<> inertia = rotation * body.GetInertia() * rotation.transpose();
    add_point(inertia, body.GetMass(), body.GetPos() - point);
    return inertia;
}

inline WholeCar whole_car(const chrono::ChSystem& system) {
    WholeCar car;
    for (auto& body : system.GetBodies()) {
        car.mass_kg += body->GetMass();
        car.cg_m += body->GetPos() * body->GetMass();
    }
    car.cg_m = car.cg_m * (1 / car.mass_kg);
    car.inertia_kg_m2.setZero();
    for (auto& body : system.GetBodies())
        car.inertia_kg_m2 += inertia_about(*body, car.cg_m);
    return car;
}

// Momentum and kinetic energy of all bodies and shafts.
inline Momentum momentum(const chrono::ChSystem& system) {
    Momentum sum;
    for (auto& body : system.GetBodies()) {
        if (body->IsFixed())
            continue;
        const auto velocity = body->GetPosDt();
        const auto spin = body->GetAngVelLocal();
        const auto angular = chrono::ChVector3d(body->GetInertia() * spin.eigen());
        sum.kinetic_energy_j += 0.5 * body->GetMass() * velocity.Length2() + 0.5 * Vdot(spin, angular);
        sum.linear_n_s += velocity * body->GetMass();
    }
    for (auto& shaft : system.GetShafts())
        sum.kinetic_energy_j += 0.5 * shaft->GetInertia() * shaft->GetPosDt() * shaft->GetPosDt();
    return sum;
}

// The body such that the whole car at its design height has the mass properties of its description.
inline BodyMass solve_body(const CarDescription& description) {
    using namespace chrono;
    BodyMass any;
    any.inertia_kg_m2.setZero();
    any.inertia_kg_m2(0, 0) = 500;
    any.inertia_kg_m2(1, 1) = any.inertia_kg_m2(2, 2) = 2000;
    ChSystemNSC system;
    Car car(&system, description, any, 0, 5e-4);
    const ChBody* chassis = car.GetChassisBody().get();
    const ChVector3d origin(0, 0, description.design_height_m);
    const ChVector3d cg =
        ChVector3d(-description.cg_to_front_axle_m, 0, description.cg_height_m - description.design_height_m);
    double mass_kg = 0;
    ChVector3d moment(0, 0, 0);
    ChMatrix33<> inertia;
    inertia.setZero();
    for (auto& part : system.GetBodies()) {
        if (part.get() == chassis)
            continue;
        mass_kg += part->GetMass();
        moment += (part->GetPos() - origin) * part->GetMass();
        inertia += inertia_about(*part, origin + cg);
    }
    BodyMass body;
    body.mass_kg = description.mass_kg - mass_kg;
    body.cg_m = (cg * description.mass_kg - moment) * (1 / body.mass_kg);
    ChMatrix33<> rest;
    rest.setZero();
    rest(0, 0) = description.roll_inertia_kg_m2;
    rest(1, 1) = description.pitch_inertia_kg_m2;
    rest(2, 2) = description.yaw_inertia_kg_m2;
    rest(0, 2) = rest(2, 0) = -description.roll_yaw_product_kg_m2;
    rest -= inertia;
    add_point(rest, -body.mass_kg, body.cg_m - cg);
    // A body that is symmetric.
    rest(0, 1) = rest(1, 0) = rest(1, 2) = rest(2, 1) = 0;
    body.inertia_kg_m2 = rest;
    const double about_x = rest(0, 0), about_y = rest(1, 1), about_z = rest(2, 2);
    const bool is_body = body.mass_kg > 0 && about_x > 0 && about_y > 0 && about_z > 0 &&
                         about_x + about_y > about_z && about_y + about_z > about_x &&
                         about_x + about_z > about_y;
    if (!is_body)
        throw std::runtime_error(description.name + ": no body gives the car these mass properties");
    return body;
}
