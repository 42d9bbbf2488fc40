// The contact force over time: linear between its samples, so that the impulse over any interval is exact.
#pragma once

#include <algorithm>
#include <vector>

#include "json.hpp"

struct PlanarForce {
    double x_n = 0, y_n = 0;
};

// A force along and across the heading of the car.
class ForceHistory {
  public:
    static ForceHistory read(const json::Value& object) {
        ForceHistory history;
        history.m_time_s = json::numbers(object, "time_s");
        history.m_x = component(history.m_time_s, json::numbers(object, "fx_n", history.m_time_s.size()));
        history.m_y = component(history.m_time_s, json::numbers(object, "fy_n", history.m_time_s.size()));
        if (history.m_time_s.size() < 2)
            throw std::runtime_error("a force has fewer than two samples");
        return history;
    }

    bool is_empty() const { return m_time_s.empty(); }
    double end_s() const { return is_empty() ? 0.0 : m_time_s.back(); }

    // Mean force over an interval.
    PlanarForce mean(double from_s, double to_s) const {
        const double length_s = to_s - from_s;
        return {(impulse(m_x, to_s) - impulse(m_x, from_s)) / length_s,
                (impulse(m_y, to_s) - impulse(m_y, from_s)) / length_s};
    }

    // Impulse of the whole history, N s.
    PlanarForce total() const {
        return is_empty() ? PlanarForce{} : PlanarForce{m_x.impulse_n_s.back(), m_y.impulse_n_s.back()};
    }

  private:
    struct Component {
        std::vector<double> force_n, impulse_n_s;
    };

    static Component component(const std::vector<double>& time_s, std::vector<double> force_n) {
        Component result{std::move(force_n), std::vector<double>(time_s.size(), 0.0)};
        for (size_t i = 1; i < time_s.size(); i++) {
            const double step_s = time_s[i] - time_s[i - 1];
            if (step_s <= 0)
                throw std::runtime_error("time_s of a force does not grow");
            result.impulse_n_s[i] =
                result.impulse_n_s[i - 1] + 0.5 * step_s * (result.force_n[i] + result.force_n[i - 1]);
        }
        return result;
    }

    double impulse(const Component& of, double until_s) const {
        if (is_empty() || until_s <= m_time_s.front())
            return 0;
        if (until_s >= m_time_s.back())
            return of.impulse_n_s.back();
        const size_t i = std::upper_bound(m_time_s.begin(), m_time_s.end(), until_s) - m_time_s.begin();
        const double since_s = until_s - m_time_s[i - 1];
        const double slope = (of.force_n[i] - of.force_n[i - 1]) / (m_time_s[i] - m_time_s[i - 1]);
        return of.impulse_n_s[i - 1] + of.force_n[i - 1] * since_s + 0.5 * slope * since_s * since_s;
    }

    std::vector<double> m_time_s;
    Component m_x, m_y;
};
