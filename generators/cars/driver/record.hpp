// The record of a motion: one row per output interval, columns as impactlab reads them.
#pragma once

#include <cstdio>

#include "loads.hpp"

struct RecordRow {
    double time_s, x_m, y_m, yaw_rad, roll_rad, forward_m_s, left_m_s, yaw_rate_rad_s, roll_rate_rad_s;
    PlanarForce mean_force;
    std::array<double, 2> front_angle_rad;
    std::array<double, kWheels> load_n;

    bool is_at_rest() const {
        return std::hypot(forward_m_s, left_m_s) < 0.03 && std::abs(yaw_rate_rad_s) < 0.02;
    }
};

// Counts full turns, so that the yaw angle goes on beyond half a turn.
class TurnCounter {
  public:
    double unwrapped(double yaw_rad) {
        if (yaw_rad - m_last_rad > M_PI)
            m_turns_rad -= 2 * M_PI;
        if (yaw_rad - m_last_rad < -M_PI)
            m_turns_rad += 2 * M_PI;
        m_last_rad = yaw_rad;
        return yaw_rad + m_turns_rad;
    }

  private:
    double m_last_rad = 0, m_turns_rad = 0;
};

class Record {
  public:
    explicit Record(const std::string& path) : m_file(std::fopen(path.c_str(), "w")) {
        if (!m_file)
            throw std::runtime_error(path + ": cannot be written");
        std::fprintf(m_file,
                     "time_s,x_m,y_m,yaw_rad,roll_rad,vx_m_s,vy_m_s,yaw_rate_rad_s,roll_rate_rad_s,fx_body_n,"
                     "fy_body_n,steer_fl_rad,steer_fr_rad,fz_fl_n,fz_fr_n,fz_rl_n,fz_rr_n\n");
    }
    Record(const Record&) = delete;
    Record& operator=(const Record&) = delete;
    ~Record() { std::fclose(m_file); }

    void write(const RecordRow& row) {
        std::fprintf(m_file, "%.3f,%.4f,%.4f,%.5f,%.5f,%.4f,%.4f,%.5f,%.5f,%.1f,%.1f,%.5f,%.5f", row.time_s,
                     row.x_m, row.y_m, row.yaw_rad, row.roll_rad, row.forward_m_s, row.left_m_s,
                     row.yaw_rate_rad_s, row.roll_rate_rad_s, row.mean_force.x_n, row.mean_force.y_n,
                     row.front_angle_rad[0], row.front_angle_rad[1]);
        for (double load_n : row.load_n)
            std::fprintf(m_file, ",%.0f", load_n);
        std::fprintf(m_file, "\n");
    }

  private:
    std::FILE* m_file;
};
