// What is recorded of a pair: motions and controls every 10 ms, the contact force every millisecond.
#pragma once

#include "drivers.hpp"

struct PairRow {
    double time_s = 0;
    CarState struck, striking;
    // Mean over the interval that follows.
    double force_x_n = 0, force_y_n = 0, moment_n_m = 0;
    double gap_m = 0;
    Controls of_struck, of_striking;
    bool stability_control_acts = false;
};

// A millisecond of contact; points in the body axes of both cars.
struct ContactRow {
    int interval = 0;
    double time_s = 0, x_n = 0, y_n = 0, struck_moment_n_m = 0, striking_moment_n_m = 0;
    Point on_struck, on_striking;
};

class CsvFile {
  public:
    CsvFile(const std::string& path, const std::string& header) : m_file(std::fopen(path.c_str(), "w")) {
        if (!m_file)
            throw std::runtime_error(path + ": cannot be written");
        std::fprintf(m_file, "%s\n", header.c_str());
    }
    CsvFile(const CsvFile&) = delete;
    CsvFile& operator=(const CsvFile&) = delete;
    ~CsvFile() { std::fclose(m_file); }

    CsvFile& put(double value, int digits) {
        separate();
        char text[48];
        std::snprintf(text, sizeof text, "%.*f", digits, value);
        std::fputs(shortened(text).c_str(), m_file);
        return *this;
    }
    CsvFile& none() {
        separate();
        return *this;
    }
    void end() {
        std::fputc('\n', m_file);
        m_begun = false;
    }

  private:
    void separate() {
        if (m_begun)
            std::fputc(',', m_file);
        m_begun = true;
    }
    static std::string shortened(std::string text) {
        if (text.find('.') != std::string::npos) {
            while (text.back() == '0')
                text.pop_back();
            if (text.back() == '.')
                text.pop_back();
        }
        return text == "-0" ? "0" : text;
    }

    std::FILE* m_file;
    bool m_begun = false;
};

// Steering wheel over the mean angle of the front wheels.
constexpr double kSteeringRatio = 16;
// Gaps that are larger are not known and left empty.
constexpr double kLargestGapM = 50;

inline void write_motions(const std::vector<PairRow>& rows, const std::string& path) {
    std::string header = "time_s";
    for (const char* car : {"target", "bullet"})
        for (const char* what : {"x_m", "y_m", "yaw_rad", "roll_rad", "vx_m_s", "vy_m_s", "yaw_rate_rad_s",
                                 "roll_rate_rad_s"})
            header += std::string(",") + car + "_" + what;
    header +=
        ",contact_fx_n,contact_fy_n,contact_mz_nm,gap_m,target_steering_wheel_rad,target_steer_fl_rad,"
        "target_steer_fr_rad,target_brake_fl_n_m,target_brake_fr_n_m,target_brake_rl_n_m,"
        "target_brake_rr_n_m,target_drive_n_m,target_esc_active,bullet_steering_wheel_rad,"
        "bullet_steer_rad,bullet_brake_n_m,bullet_drive_n_m";
    CsvFile file(path, header);
    for (const PairRow& row : rows) {
        file.put(row.time_s, 2);
        for (const CarState* car : {&row.struck, &row.striking}) {
            file.put(car->x_m, 4).put(car->y_m, 4).put(car->yaw_rad, 5).put(car->roll_rad, 5);
            file.put(car->forward_m_s, 4).put(car->left_m_s, 4);
            file.put(car->yaw_rate_rad_s, 5).put(car->roll_rate_rad_s, 5);
        }
        file.put(row.force_x_n, 1).put(row.force_y_n, 1).put(row.moment_n_m, 1);
        row.gap_m < kLargestGapM ? file.put(row.gap_m, 3) : file.none();
        file.put(row.of_struck.steer_rad * kSteeringRatio, 4);
        file.put(row.struck.front_angle_rad[0], 5).put(row.struck.front_angle_rad[1], 5);
        for (double torque_n_m : row.of_struck.brake_n_m)
            file.put(torque_n_m, 0);
        file.put(2 * row.of_struck.drive_n_m, 0).put(row.stability_control_acts, 0);
        file.put(row.of_striking.steer_rad * kSteeringRatio, 4).put(row.striking.front_mean_rad(), 5);
        file.put(row.of_striking.brakes_n_m(), 0).put(2 * row.of_striking.drive_n_m, 0);
        file.end();
    }
}

inline void write_contact(const std::vector<ContactRow>& rows, const std::string& path) {
    CsvFile file(path,
                 "interval,time_s,fx_n,fy_n,mz_nm,bullet_mz_nm,point_x_m,point_y_m,bullet_point_x_m,"
                 "bullet_point_y_m");
    for (const ContactRow& row : rows) {
        file.put(row.interval, 0).put(row.time_s, 4).put(row.x_n, 2).put(row.y_n, 2);
        file.put(row.struck_moment_n_m, 2).put(row.striking_moment_n_m, 2);
        file.put(row.on_struck.x, 4).put(row.on_struck.y, 4);
        file.put(row.on_striking.x, 4).put(row.on_striking.y, 4).end();
    }
}
