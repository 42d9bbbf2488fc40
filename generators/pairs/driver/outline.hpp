// Plan view of a car that can be crushed: a closed polygon of nodes, each with its stiffness and its dent.
//
// Body axes from the centre of gravity, x forward, y left. A node is pushed in along its own inward normal
// and stays there. Force per metre of outline that pushes it further, at a dent p:
//   y(p) = y0 + s k p                   for p < d   (skin: bumper cover, door skin, lip of a wheel arch)
//   y(p) = y0 + s k d + k (p - d)       beyond      (structure), at most the largest force
// k and d depend on the place: flank, door, pillar, wheel arch, front, rear.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../../cars/driver/json.hpp"

struct BodyShape {
    double cg_to_front_axle_m, cg_to_rear_axle_m, front_overhang_m, rear_overhang_m, width_m, wheel_radius_m;

    static BodyShape read(const json::Value& object) {
        return {json::number(object, "cg_to_front_axle_m"), json::number(object, "cg_to_rear_axle_m"),
                json::number(object, "front_overhang_m"),   json::number(object, "rear_overhang_m"),
                json::number(object, "width_m"),            json::number(object, "wheel_radius_m")};
    }
};

// Stiffness and forces per metre of outline.
struct CrushLaw {
    double side_n_m2, front_n_m2, rear_n_m2;
    // Stiffness of the skin over that of the structure, and its depth.
    double skin_share, side_skin_m, end_skin_m, arch_skin_m;
    double first_force_n_m, largest_force_n_m;
    // Stiffness over that of the flank.
    double arch_factor, pillar_factor, door_factor;
    // A dent is no steeper than that.
    double dent_slope;

    static CrushLaw read(const json::Value& object) {
        const auto number = [&](const char* key) { return json::number(object, key); };
        return {number("side_n_m2"),   number("front_n_m2"),      number("rear_n_m2"),
                number("skin_share"),  number("side_skin_m"),     number("end_skin_m"),
                number("arch_skin_m"), number("first_force_n_m"), number("largest_force_n_m"),
                number("arch_factor"), number("pillar_factor"),   number("door_factor"),
                number("dent_slope")};
    }
};

struct Point {
    double x = 0, y = 0;
};

class Outline {
  public:
    Outline(const BodyShape& shape, const CrushLaw& law) : m_law(law) {
        const std::vector<Point> half = half_outline(shape);
        // Counter-clockwise: the right half from the rear to the front, the left half back.
        for (const Point& point : half)
            m_nodes.push_back({{point.x, -point.y}});
        for (size_t i = half.size() - 1; i-- > 1;)
            m_nodes.push_back({half[i]});
        for (int i = 0; i < size(); i++)
            m_nodes[i].crushed = m_nodes[i].at;
        for (int i = 0; i < size(); i++)
            describe(i, shape);
    }

    int size() const { return static_cast<int>(m_nodes.size()); }
    int after(int node) const { return node + 1 == size() ? 0 : node + 1; }
    int before(int node) const { return node == 0 ? size() - 1 : node - 1; }
    const Point& at(int node) const { return m_nodes[node].at; }
    // Where the node is with its dent.
    const Point& crushed(int node) const { return m_nodes[node].crushed; }
    const Point& normal(int node) const { return m_nodes[node].normal; }
    double length_m(int node) const { return m_nodes[node].length_m; }
    double reach_m() const { return m_reach_m; }

    // Whether a point may lie within the outline, and how far it is at least outside of it.
    bool may_hold(const Point& point) const {
        return point.x >= m_least.x && point.x <= m_largest.x && point.y >= m_least.y &&
               point.y <= m_largest.y;
    }
    double least_distance_m(const Point& point) const {
        const double along = std::max({m_least.x - point.x, point.x - m_largest.x, 0.0});
        const double across = std::max({m_least.y - point.y, point.y - m_largest.y, 0.0});
        return std::hypot(along, across);
    }

    // Force per metre that pushes a node further, and how it grows with the dent.
    double yield_n_m(int node) const {
        const Node& of = m_nodes[node];
        const double skin = m_law.skin_share * of.stiffness_n_m2;
        const double force = of.dent_m < of.skin_m ? m_law.first_force_n_m + skin * of.dent_m
                                                   : m_law.first_force_n_m + skin * of.skin_m +
                                                         of.stiffness_n_m2 * (of.dent_m - of.skin_m);
        return std::min(force, m_law.largest_force_n_m);
    }
    double hardening_n_m2(int node) const {
        const Node& of = m_nodes[node];
        if (of.dent_m < of.skin_m)
            return m_law.skin_share * of.stiffness_n_m2;
        const bool grows = yield_n_m(node) < m_law.largest_force_n_m;
        return grows ? of.stiffness_n_m2 : kHardeningAtLargestForce * of.stiffness_n_m2;
    }

    void push_in(int node, double by_m) { m_nodes[node].dent_m += by_m; }

    // Neighbours follow a dent.
    void spread_dents() {
        const int n = size();
        for (int i = 0; i < 2 * n; i++)
            follow(i % n, after(i % n));
        for (int i = 2 * n; i > 0; i--)
            follow(i % n, before(i % n));
        for (Node& node : m_nodes)
            node.crushed = {node.at.x - node.normal.x * node.dent_m, node.at.y - node.normal.y * node.dent_m};
    }

    double largest_dent_m() const {
        double largest_m = 0;
        for (const Node& node : m_nodes)
            largest_m = std::max(largest_m, node.dent_m);
        return largest_m;
    }

  private:
    // Distance of the nodes, m; that of the points before the corners are rounded; half width of the moving
    // average that rounds them, in points.
    static constexpr double kNodeDistanceM = 0.04, kFineDistanceM = 0.01;
    static constexpr int kRounding = 8, kRoundings = 2, kCornersCut = 3, kPointsPerSide = 24;
    // Setback and narrowing of the ends of the car for which lengths are told, and where they begin.
    static constexpr double kFrontSetbackM = 0.20, kRearSetbackM = 0.13;
    static constexpr double kFrontNarrowing = 0.16, kRearNarrowing = 0.10;
    static constexpr double kFrontLengthM = 0.55, kRearLengthM = 0.50;
    static constexpr double kUsualFrontM = 0.92, kUsualRearM = 1.08, kUsualWidthM = 1.85;
    // Place of the B-pillar ahead of the rear axle over the wheelbase, and its half width.
    static constexpr double kPillarPlace = 0.42, kPillarHalfM = 0.12;
    static constexpr double kArchBesideWheelM = 0.06;
    // From where on a bumper begins: wheel radii ahead of the front axle.
    static constexpr double kBumperFrom = 0.8;
    static constexpr double kHardeningAtLargestForce = 0.02;

    struct Node {
        Point at, crushed{}, normal{};
        double length_m = 0, stiffness_n_m2 = 0, skin_m = 0, dent_m = 0;
    };

    // From the middle of the rear along the left flank to the middle of the front.
    static std::vector<Point> half_outline(const BodyShape& shape) {
        const double front = shape.cg_to_front_axle_m + shape.front_overhang_m;
        const double rear = -shape.cg_to_rear_axle_m - shape.rear_overhang_m;
        const double half_width = shape.width_m / 2, wide = shape.width_m / kUsualWidthM;
        const double front_over_usual = shape.front_overhang_m / kUsualFrontM;
        const double rear_over_usual = shape.rear_overhang_m / kUsualRearM;
        const double front_setback = kFrontSetbackM * wide * std::min(1.0, front_over_usual);
        const double rear_setback = kRearSetbackM * wide * std::min(1.0, rear_over_usual);
        const double front_length = kFrontLengthM * front_over_usual;
        const double rear_length = kRearLengthM * rear_over_usual;
        std::vector<Point> points;
        const auto share = [](int i) { return static_cast<double>(i) / kPointsPerSide; };
        for (int i = 0; i <= kPointsPerSide; i++)
            points.push_back({rear + rear_setback * std::pow(share(i), 3),
                              half_width * (1 - kRearNarrowing) * share(i)});
        for (int i = 1; i <= kPointsPerSide; i++) {
            const Point flank{rear + rear_length * share(i),
                              half_width * (1 - kRearNarrowing * std::pow(1 - share(i), 2))};
            if (flank.x > rear + rear_setback)
                points.push_back(flank);
        }
        for (int i = 0; i <= kPointsPerSide; i++) {
            const Point flank{front - front_length * (1 - share(i)),
                              half_width * (1 - kFrontNarrowing * std::pow(share(i), 2))};
            if (flank.x < front - front_setback)
                points.push_back(flank);
        }
        for (int i = kPointsPerSide; i >= 0; i--)
            points.push_back({front - front_setback * std::pow(share(i), 3),
                              half_width * (1 - kFrontNarrowing) * share(i)});
        return rounded(points);
    }

    static std::vector<Point> rounded(std::vector<Point> points) {
        for (int round = 0; round < kCornersCut; round++)
            points = with_corners_cut(points);
        for (int round = 0; round < kRoundings; round++)
            points = averaged(resampled(points, kFineDistanceM));
        return resampled(points, kNodeDistanceM);
    }

    static std::vector<Point> with_corners_cut(const std::vector<Point>& points) {
        std::vector<Point> cut{points.front()};
        for (size_t i = 0; i + 1 < points.size(); i++)
            for (double share : {0.25, 0.75})
                cut.push_back({(1 - share) * points[i].x + share * points[i + 1].x,
                               (1 - share) * points[i].y + share * points[i + 1].y});
        cut.push_back(points.back());
        return cut;
    }

    static std::vector<Point> averaged(const std::vector<Point>& points) {
        std::vector<Point> means = points;
        const int n = static_cast<int>(points.size());
        for (int i = 1; i + 1 < n; i++) {
            const int reach = std::min({kRounding, i, n - 1 - i});
            Point sum;
            for (int j = i - reach; j <= i + reach; j++)
                sum = {sum.x + points[j].x, sum.y + points[j].y};
            means[i] = {sum.x / (2 * reach + 1), sum.y / (2 * reach + 1)};
        }
        return means;
    }

    // Points at equal distances; both ends lie on the middle line.
    static std::vector<Point> resampled(const std::vector<Point>& points, double distance_m) {
        std::vector<double> way_m{0};
        for (size_t i = 1; i < points.size(); i++)
            way_m.push_back(way_m.back() +
                            std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y));
        const int n = std::max(4, static_cast<int>(std::lround(way_m.back() / distance_m)));
        std::vector<Point> even;
        size_t j = 0;
        for (int i = 0; i <= n; i++) {
            const double at_m = way_m.back() * i / n;
            while (j + 2 < way_m.size() && way_m[j + 1] < at_m)
                j++;
            const double length_m = std::max(1e-12, way_m[j + 1] - way_m[j]);
            const double share = std::clamp((at_m - way_m[j]) / length_m, 0.0, 1.0);
            even.push_back({points[j].x + share * (points[j + 1].x - points[j].x),
                            points[j].y + share * (points[j + 1].y - points[j].y)});
        }
        even.front().y = even.back().y = 0;
        return even;
    }

    // 1 within, falling to 0 at the edge.
    static double bell(double distance_m, double half_m) {
        const double share = std::abs(distance_m) / half_m;
        if (share >= 1)
            return 0;
        return share < 0.7 ? 1 : 0.5 * (1 + std::cos(M_PI * (share - 0.7) / 0.3));
    }

    // Normal, length and stiffness of a node.
    void describe(int i, const BodyShape& shape) {
        Node& node = m_nodes[i];
        const Point from = m_nodes[before(i)].at, to = m_nodes[after(i)].at;
        const double chord_m = std::hypot(to.x - from.x, to.y - from.y);
        node.normal = {(to.y - from.y) / chord_m, -(to.x - from.x) / chord_m};
        node.length_m = chord_m / 2;
        const double x = node.at.x, front_axle = shape.cg_to_front_axle_m,
                     rear_axle = -shape.cg_to_rear_axle_m;
        const double front = std::clamp((node.normal.x - 0.25) / 0.35, 0.0, 1.0);
        const double rear = std::clamp((-node.normal.x - 0.25) / 0.35, 0.0, 1.0);
        const double arch_m = shape.wheel_radius_m + kArchBesideWheelM;
        const double arch = std::max(bell(x - rear_axle, arch_m), bell(x - front_axle, arch_m));
        const double pillar = bell(x - rear_axle - kPillarPlace * (front_axle - rear_axle), kPillarHalfM);
        const double door = x > rear_axle + arch_m && x < front_axle - arch_m ? 1 : 0;
        const double factor = 1 + (m_law.arch_factor - 1) * arch + (m_law.pillar_factor - 1) * pillar +
                              (m_law.door_factor - 1) * door * (1 - pillar);
        node.stiffness_n_m2 = m_law.side_n_m2 * factor * (1 - front - rear) + m_law.front_n_m2 * front +
                              m_law.rear_n_m2 * rear;
        const double bumper_from_m = kBumperFrom * shape.wheel_radius_m;
        if (x > front_axle + bumper_from_m) {
            // The ends of the bumper reach around the corners.
            const double length_m = std::max(0.1, shape.front_overhang_m - bumper_from_m);
            const double share = std::clamp((x - front_axle - bumper_from_m) / length_m, 0.0, 1.0);
            const double at_end_n_m2 = m_law.side_n_m2 + (m_law.front_n_m2 - m_law.side_n_m2) * share;
            node.stiffness_n_m2 = std::max(node.stiffness_n_m2, at_end_n_m2);
        }
        node.skin_m = (m_law.side_skin_m + (m_law.arch_skin_m - m_law.side_skin_m) * arch) *
                          (1 - front - rear) +
                      m_law.end_skin_m * (front + rear);
        m_reach_m = std::max(m_reach_m, std::hypot(x, node.at.y));
        m_least = {std::min(m_least.x, x), std::min(m_least.y, node.at.y)};
        m_largest = {std::max(m_largest.x, x), std::max(m_largest.y, node.at.y)};
    }

    void follow(int node, int neighbour) {
        const double apart_m = (m_nodes[node].length_m + m_nodes[neighbour].length_m) / 2;
        const double least_m = m_nodes[node].dent_m - m_law.dent_slope * apart_m;
        m_nodes[neighbour].dent_m = std::max(m_nodes[neighbour].dent_m, least_m);
    }

    CrushLaw m_law;
    std::vector<Node> m_nodes;
    double m_reach_m = 0;
    Point m_least{1e9, 1e9}, m_largest{-1e9, -1e9};
};
