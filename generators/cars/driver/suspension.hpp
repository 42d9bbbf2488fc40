// Suspension: the templates of Chrono that a car may have, and the force laws of springs and dampers.
#pragma once

#include "car_description.hpp"
#include "chrono/physics/ChLinkTSDA.h"
#include "chrono_vehicle/wheeled_vehicle/steering/PitmanArm.h"
#include "chrono_vehicle/wheeled_vehicle/steering/RackPinion.h"
#include "chrono_vehicle/wheeled_vehicle/steering/RotaryArm.h"
#include "chrono_vehicle/wheeled_vehicle/suspension/DoubleWishbone.h"
#include "chrono_vehicle/wheeled_vehicle/suspension/LeafspringAxle.h"
#include "chrono_vehicle/wheeled_vehicle/suspension/MacPhersonStrut.h"
#include "chrono_vehicle/wheeled_vehicle/suspension/MultiLink.h"
#include "chrono_vehicle/wheeled_vehicle/suspension/RigidPanhardAxle.h"
#include "chrono_vehicle/wheeled_vehicle/suspension/SemiTrailingArm.h"
#include "chrono_vehicle/wheeled_vehicle/suspension/SolidAxle.h"
#include "chrono_vehicle/wheeled_vehicle/suspension/ThreeLinkIRS.h"
#include "chrono_vehicle/wheeled_vehicle/suspension/ToeBarLeafspringAxle.h"
#include "chrono_vehicle/wheeled_vehicle/suspension/ToeBarRigidPanhardAxle.h"

// Linear about the design length; beyond the free travel a stop makes it three times as stiff.
class SpringForce : public chrono::ChLinkTSDA::ForceFunctor {
  public:
    SpringForce(double stiffness_n_m, double preload_n, double design_length_m, double free_travel_m)
        : m_stiffness_n_m(stiffness_n_m),
          m_preload_n(preload_n),
          m_design_length_m(design_length_m),
          m_free_travel_m(free_travel_m) {}

    double evaluate(double, double, double length_m, double, const chrono::ChLinkTSDA&) override {
        const double extension_m = length_m - m_design_length_m;
        double force_n = m_preload_n - m_stiffness_n_m * extension_m;
        if (extension_m < -m_free_travel_m)
            force_n -= 2 * m_stiffness_n_m * (extension_m + m_free_travel_m);
        if (extension_m > m_free_travel_m)
            force_n -= 2 * m_stiffness_n_m * (extension_m - m_free_travel_m);
        return force_n;
    }

    double design_length_m() const { return m_design_length_m; }

  private:
    double m_stiffness_n_m, m_preload_n, m_design_length_m, m_free_travel_m;
};

// Degressive damper.
class DamperForce : public chrono::ChLinkTSDA::ForceFunctor {
  public:
    DamperForce(double damping_n_s_m, double degressivity_s_m)
        : m_damping_n_s_m(damping_n_s_m), m_degressivity_s_m(degressivity_s_m) {}

    double evaluate(double, double, double, double speed_m_s, const chrono::ChLinkTSDA&) override {
        return -m_damping_n_s_m * speed_m_s / (1 + m_degressivity_s_m * std::abs(speed_m_s));
    }

  private:
    double m_damping_n_s_m, m_degressivity_s_m;
};

template <class Template>
std::shared_ptr<Template> from_file(const std::string& file) {
    return chrono_types::make_shared<Template>(file);
}

inline std::shared_ptr<chrono::vehicle::ChSuspension> make_suspension(const Subsystem& of) {
    using namespace chrono::vehicle;
    const std::string& name = of.template_name;
    if (name == "DoubleWishbone")
        return from_file<DoubleWishbone>(of.file);
    if (name == "MultiLink")
        return from_file<MultiLink>(of.file);
    if (name == "MacPhersonStrut")
        return from_file<MacPhersonStrut>(of.file);
    if (name == "SemiTrailingArm")
        return from_file<SemiTrailingArm>(of.file);
    if (name == "SolidAxle")
        return from_file<SolidAxle>(of.file);
    if (name == "LeafspringAxle")
        return from_file<LeafspringAxle>(of.file);
    if (name == "ToeBarLeafspringAxle")
        return from_file<ToeBarLeafspringAxle>(of.file);
    if (name == "RigidPanhardAxle")
        return from_file<RigidPanhardAxle>(of.file);
    if (name == "ToeBarRigidPanhardAxle")
        return from_file<ToeBarRigidPanhardAxle>(of.file);
    if (name == "ThreeLinkIRS")
        return from_file<ThreeLinkIRS>(of.file);
    throw std::runtime_error("there is no suspension " + name);
}

inline std::shared_ptr<chrono::vehicle::ChSteering> make_steering(const Subsystem& of) {
    using namespace chrono::vehicle;
    const std::string& name = of.template_name;
    if (name == "RackPinion")
        return from_file<RackPinion>(of.file);
    if (name == "PitmanArm")
        return from_file<PitmanArm>(of.file);
    if (name == "RotaryArm")
        return from_file<RotaryArm>(of.file);
    throw std::runtime_error("there is no steering " + name);
}
