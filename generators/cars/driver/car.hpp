// The car: a rigid body, two axles of Chrono's suspensions, a steering, wheels and tires.
//
// There is no driveline and no powertrain: the gearbox is in neutral. Wheels are numbered front left, front
// right, rear left, rear right.
#pragma once

#include "chrono/physics/ChLinkTSDA.h"
#include "chrono/physics/ChSystemNSC.h"
#include "chrono_vehicle/chassis/ChRigidChassis.h"
#include "chrono_vehicle/wheeled_vehicle/ChWheel.h"
#include "chrono_vehicle/wheeled_vehicle/ChWheeledVehicle.h"
#include "suspension.hpp"
#include "tire.hpp"

constexpr int kWheels = 4;

inline int axle_of(int wheel) {
    return wheel / 2;
}

inline chrono::vehicle::VehicleSide side_of(int wheel) {
    return wheel % 2 == 0 ? chrono::vehicle::LEFT : chrono::vehicle::RIGHT;
}

// Mass properties of the body alone; its frame lies at the front axle, at the design height.
struct BodyMass {
    double mass_kg = 1000;
    chrono::ChVector3d cg_m{0, 0, 0};
    chrono::ChMatrix33<> inertia_kg_m2;
};

class Chassis : public chrono::vehicle::ChRigidChassis {
  public:
    Chassis(const std::string& name, const BodyMass& body) : ChRigidChassis(name, false), m_body(body) {}
    chrono::ChCoordsys<> GetLocalDriverCoordsys() const override { return chrono::ChCoordsys<>(); }

  protected:
    double GetBodyMass() const override { return m_body.mass_kg; }
    chrono::ChMatrix33<> GetBodyInertia() const override { return m_body.inertia_kg_m2; }
    chrono::ChFrame<> GetBodyCOMFrame() const override {
        return chrono::ChFrame<>(m_body.cg_m, chrono::QUNIT);
    }

  private:
    BodyMass m_body;
};

// A wheel with its tire.
class Wheel : public chrono::vehicle::ChWheel {
  public:
    Wheel(const std::string& name, const AxleDescription& axle)
        : ChWheel(name),
          m_mass_kg(axle.wheel_mass_kg),
          m_inertia_kg_m2(axle.wheel_cross_inertia_kg_m2, axle.wheel_spin_inertia_kg_m2,
                          axle.wheel_cross_inertia_kg_m2) {}
    double GetWheelMass() const override { return m_mass_kg; }
    const chrono::ChVector3d& GetWheelInertia() const override { return m_inertia_kg_m2; }

  private:
    double m_mass_kg;
    chrono::ChVector3d m_inertia_kg_m2;
};

class Car : public chrono::vehicle::ChWheeledVehicle {
  public:
    // A spring whose force law is that of the description.
    struct Spring {
        int axle;
        std::shared_ptr<chrono::ChLinkTSDA> link;
        std::shared_ptr<SpringForce> force;
    };
    // A wheel with what carries it, and the accumulators of the forces on both.
    struct Corner {
        std::shared_ptr<Tire> tire;
        std::shared_ptr<chrono::vehicle::ChSpindle> spindle;
        chrono::ChBody* carrier;
        unsigned spindle_forces, carrier_forces;
        chrono::ChVector3d design_position_m;
    };

    // Puts the car at the design height into the system, rolling forward.
    Car(chrono::ChSystem* system, const CarDescription& description, const BodyMass& body, double speed_m_s,
        double step_s)
        : ChWheeledVehicle(description.name, system), m_description(description), m_step_s(step_s) {
        m_chassis = chrono_types::make_shared<Chassis>("Chassis", body);
        m_axles.resize(2);
        for (int axle = 0; axle < 2; axle++) {
            m_axles[axle] = chrono_types::make_shared<chrono::vehicle::ChAxle>();
            m_axles[axle]->m_suspension = make_suspension(description.axles[axle].suspension);
            m_axles[axle]->m_suspension->SetName(axle == 0 ? "FrontSusp" : "RearSusp");
            for (const char* side : {"L", "R"})
                m_axles[axle]->m_wheels.push_back(
                    chrono_types::make_shared<Wheel>(side, description.axles[axle]));
        }
        m_steerings.push_back(make_steering(description.steering));
        Initialize(chrono::ChCoordsys<>(chrono::ChVector3d(0, 0, description.design_height_m), chrono::QUNIT),
                   speed_m_s);
    }

    void Initialize(const chrono::ChCoordsys<>& position, double speed_m_s) override {
        using namespace chrono;
        m_chassis->Initialize(this, position, speed_m_s, vehicle::VehicleCollisionFamily::CHASSIS_FAMILY);
        m_steerings[0]->Initialize(m_chassis, m_description.steering.location_m, QUNIT);
        for (int axle = 0; axle < 2; axle++) {
            const double spin_rad_s = speed_m_s / m_description.axles[axle].rolling_radius_m;
            m_axles[axle]->Initialize(m_chassis, nullptr, axle == 0 ? m_steerings[0] : nullptr,
                                      m_description.axles[axle].suspension.location_m, ChVector3d(0), 0,
                                      spin_rad_s, spin_rad_s);
        }
        give_springs_their_laws();
        for (auto& body : GetSystem()->GetBodies())
            body->SetPosDt(ChVector3d(speed_m_s, 0, 0));
        ChWheeledVehicle::Initialize(position, speed_m_s);
        for (int wheel = 0; wheel < kWheels; wheel++)
            m_corners[wheel] = make_corner(wheel, position.pos);
        for (auto& corner : m_corners)
            corner.carrier_forces = corner.carrier->AddAccumulator();
        InitializeInertiaProperties();
        UpdateInertiaProperties();
    }
    using ChWheeledVehicle::Initialize;

    const CarDescription& description() const { return m_description; }
    Corner& corner(int wheel) { return m_corners[wheel]; }
    const std::vector<Spring>& springs() const { return m_springs; }
    double mean_front_angle_rad() const {
        return 0.5 *
               (GetSteeringAngle(0, chrono::vehicle::LEFT) + GetSteeringAngle(0, chrono::vehicle::RIGHT));
    }

    // Computes the forces of the tires from the present state and hands them to the wheels. The library alone
    // would apply them one step later.
    void update_tires(double time_s, const chrono::vehicle::DriverInputs& inputs) {
        Advance(m_step_s);
        for (auto& axle : GetAxles())
            axle->Synchronize(time_s, inputs);
    }

    unsigned int GetNumberAxles() const override { return 2; }
    double GetWheelbase() const override { return m_description.wheelbase_m; }
    double GetMinTurningRadius() const override { return 5.5; }
    double GetMaxSteeringAngle() const override { return 0.6; }

  private:
    void give_springs_their_laws() {
        for (auto& link : GetSystem()->GetLinks()) {
            auto spring = std::dynamic_pointer_cast<chrono::ChLinkTSDA>(link);
            if (!spring)
                continue;
            const int axle = spring->GetName().find("Front") == 0 ? 0 : 1;
            const auto& of = m_description.axles[axle];
            if (spring->GetName().find("_spring") != std::string::npos) {
                auto force =
                    chrono_types::make_shared<SpringForce>(of.spring_stiffness_n_m, of.spring_preload_n,
                                                           spring->GetLength(), of.spring_free_travel_m);
                spring->RegisterForceFunctor(force);
                m_springs.push_back({axle, spring, force});
            }
            if (spring->GetName().find("_shock") != std::string::npos)
                spring->RegisterForceFunctor(
                    chrono_types::make_shared<DamperForce>(of.damping_n_s_m, of.degressivity_s_m));
        }
    }

    Corner make_corner(int wheel, const chrono::ChVector3d& chassis_position_m) {
        using namespace chrono::vehicle;
        auto& axle = m_axles[axle_of(wheel)];
        const VehicleSide side = side_of(wheel);
        Corner corner;
        corner.tire =
            chrono_types::make_shared<Tire>(side == LEFT ? "L" : "R", m_description, axle_of(wheel));
        corner.tire->SetStepsize(m_step_s);
        InitializeTire(corner.tire, axle->m_wheels[side == LEFT ? 0 : 1], chrono::VisualizationType::NONE,
                       ChTire::CollisionType::SINGLE_POINT);
        corner.spindle = axle->m_suspension->GetSpindle(side);
        auto bearing = axle->m_suspension->GetRevolute(side);
        corner.carrier = dynamic_cast<chrono::ChBody*>(bearing->GetBody1());
        if (corner.carrier == corner.spindle.get())
            corner.carrier = dynamic_cast<chrono::ChBody*>(bearing->GetBody2());
        corner.design_position_m = corner.spindle->GetPos() - chassis_position_m;
        corner.spindle_forces = corner.spindle->AddAccumulator();
        corner.carrier_forces = 0;
        return corner;
    }

    const CarDescription& m_description;
    double m_step_s;
    std::array<Corner, kWheels> m_corners;
    std::vector<Spring> m_springs;
};
