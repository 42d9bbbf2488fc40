// Contact of two outlines in plan view: force over crush of both, friction, and what springs back.
//
// Between two crushed outlines lies an elastic layer of stiffness k_e per metre: an overlap e gives the force
// k_e e until one side yields; its dent then grows, so that unloading follows k_e. Nodes of each car against
// the outline of the other, each with half the weight. Coulomb friction, smooth about no sliding.
#pragma once

#include "outline.hpp"

// Motion in plan view of the body axes of a car; axes of the road.
struct PlanarMotion {
    double x_m = 0, y_m = 0, yaw_rad = 0, vx_m_s = 0, vy_m_s = 0, yaw_rate_rad_s = 0;

    Point to_road(const Point& local) const {
        const Point turned = turned_to_road(local);
        return {x_m + turned.x, y_m + turned.y};
    }
    Point turned_to_road(const Point& local) const {
        const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
        return {c * local.x - s * local.y, s * local.x + c * local.y};
    }
    Point from_road(const Point& road) const {
        const double c = std::cos(yaw_rad), s = std::sin(yaw_rad), x = road.x - x_m, y = road.y - y_m;
        return {c * x + s * y, -s * x + c * y};
    }
    Point velocity_at(const Point& road) const {
        return {vx_m_s - yaw_rate_rad_s * (road.y - y_m), vy_m_s + yaw_rate_rad_s * (road.x - x_m)};
    }
};

// Force on the struck car, axes of the road; the striking car has its opposite.
struct ContactForce {
    double x_n = 0, y_n = 0;
    // About the origins of the body axes of both cars.
    double struck_moment_n_m = 0, striking_moment_n_m = 0;
    // Where it acts, weighted with the size of the forces, whose sum is `sum_n`.
    Point at_m;
    double sum_n = 0;

    double size_n() const { return std::hypot(x_n, y_n); }
};

class Contact {
  public:
    Contact(Outline struck, Outline striking, double elastic_n_m2, double friction)
        : m_struck(std::move(struck)),
          m_striking(std::move(striking)),
          m_elastic_n_m2(elastic_n_m2),
          m_friction(friction) {}

    const Outline& struck() const { return m_struck; }
    const Outline& striking() const { return m_striking; }

    // At least so far the outlines are apart; cheap.
    double least_gap_m(const PlanarMotion& struck, const PlanarMotion& striking) const {
        const double centres_m = std::hypot(struck.x_m - striking.x_m, struck.y_m - striking.y_m);
        const double reach_m = m_struck.reach_m() + m_striking.reach_m();
        if (centres_m > reach_m + kExactWithinM)
            return centres_m - reach_m;
        double least_m = kFarM;
        for (int i = 0; i < m_striking.size(); i++)
            least_m = std::min(least_m, m_struck.least_distance_m(
                                            struck.from_road(striking.to_road(m_striking.at(i)))));
        return least_m;
    }

    // Distance of the crushed outlines, negative where they overlap; exact below a metre.
    double gap_m(const PlanarMotion& struck, const PlanarMotion& striking) const {
        const double one = gap_m(m_striking, striking, m_struck, struck);
        return std::min(one, gap_m(m_struck, struck, m_striking, striking));
    }

    // The force in this place, by which both outlines are crushed further.
    ContactForce press(const PlanarMotion& struck, const PlanarMotion& striking) {
        ContactForce sum;
        m_increments.clear();
        press(m_striking, striking, m_struck, struck, false, sum);
        press(m_struck, struck, m_striking, striking, true, sum);
        for (const Increment& increment : m_increments)
            increment.outline->push_in(increment.node, increment.by_m);
        if (!m_increments.empty()) {
            m_struck.spread_dents();
            m_striking.spread_dents();
        }
        if (sum.sum_n > 0)
            sum.at_m = {sum.at_m.x / sum.sum_n, sum.at_m.y / sum.sum_n};
        return sum;
    }

  private:
    static constexpr double kExactWithinM = 1.0, kFarM = 1e9;
    // Edges further away from a node than that do not press on it.
    static constexpr double kNearM = 0.45;
    // A node whose normal is not that much against the other outline is not crushed.
    static constexpr double kLeastFacing = 0.35;
    // Sliding velocity about which friction changes its sign, m/s.
    static constexpr double kSlidingM_s = 0.15;
    // Growth of the force with the speed at which the cars close, s/m, and the speeds over which it holds.
    static constexpr double kRateS_m = 0.02, kLeastClosingM_s = -2, kLargestClosingM_s = 10;

    struct Increment {
        Outline* outline;
        int node;
        double by_m;
    };
    // Place on the nearest edge of an outline.
    struct Nearest {
        int edge = -1;
        double share = 0, depth_m = -1;
        Point normal;
    };

    double gap_m(const Outline& nodes, const PlanarMotion& of_nodes, const Outline& edges,
                 const PlanarMotion& of_edges) const {
        double least_m = kFarM;
        for (int i = 0; i < nodes.size(); i++) {
            const Point local = of_edges.from_road(of_nodes.to_road(nodes.crushed(i)));
            if (edges.least_distance_m(local) <= std::min(least_m, kExactWithinM))
                least_m = std::min(least_m, -nearest(edges, local, kFarM).depth_m);
        }
        return least_m;
    }

    // The nodes of one car against the edges of the other one.
    void press(Outline& nodes, const PlanarMotion& of_nodes, Outline& edges, const PlanarMotion& of_edges,
               bool nodes_are_struck, ContactForce& sum) {
        for (int i = 0; i < nodes.size(); i++) {
            const Point at = of_nodes.to_road(nodes.crushed(i)), local = of_edges.from_road(at);
            if (!edges.may_hold(local))
                continue;
            const Nearest found = nearest(edges, local, kNearM);
            if (found.depth_m <= 0)
                continue;
            const Point normal = of_edges.turned_to_road(found.normal);
            const Point own = of_nodes.turned_to_road(nodes.normal(i));
            const double facing = -(own.x * normal.x + own.y * normal.y);
            const double force_n_m = crushed_force_n_m(nodes, i, facing, edges, found);
            const Point one = of_nodes.velocity_at(at), other = of_edges.velocity_at(at);
            const Point relative{one.x - other.x, one.y - other.y};
            const double opening_m_s = relative.x * normal.x + relative.y * normal.y;
            const double sliding_m_s = -relative.x * normal.y + relative.y * normal.x;
            const double closing_m_s = std::clamp(-opening_m_s, kLeastClosingM_s, kLargestClosingM_s);
            const double half_m = 0.5 * nodes.length_m(i);
            const double normal_n = half_m * force_n_m * (1 + kRateS_m * closing_m_s);
            const double friction_n = -m_friction * normal_n * sliding_m_s /
                                      std::hypot(sliding_m_s, kSlidingM_s);
            const Point on_nodes{normal_n * normal.x - friction_n * normal.y,
                                 normal_n * normal.y + friction_n * normal.x};
            add(at, on_nodes, of_nodes, of_edges, nodes_are_struck, sum);
        }
    }

    static void add(const Point& at, const Point& on_nodes, const PlanarMotion& of_nodes,
                    const PlanarMotion& of_edges, bool nodes_are_struck, ContactForce& sum) {
        const auto moment = [&](const PlanarMotion& about) {
            return (at.x - about.x_m) * on_nodes.y - (at.y - about.y_m) * on_nodes.x;
        };
        const double sign = nodes_are_struck ? 1 : -1;
        const PlanarMotion& struck = nodes_are_struck ? of_nodes : of_edges;
        const PlanarMotion& striking = nodes_are_struck ? of_edges : of_nodes;
        sum.x_n += sign * on_nodes.x;
        sum.y_n += sign * on_nodes.y;
        sum.struck_moment_n_m += sign * moment(struck);
        sum.striking_moment_n_m -= sign * moment(striking);
        const double size_n = std::hypot(on_nodes.x, on_nodes.y);
        sum.at_m = {sum.at_m.x + size_n * at.x, sum.at_m.y + size_n * at.y};
        sum.sum_n += size_n;
    }

    // Elastic force of an overlap, brought back to what both sides can hold; notes how far each is crushed.
    double crushed_force_n_m(Outline& nodes, int i, double facing, Outline& edges, const Nearest& found) {
        const double elastic = m_elastic_n_m2, force = elastic * found.depth_m, share = found.share;
        const int from = found.edge, to = edges.after(found.edge);
        const double node_yield = nodes.yield_n_m(i), node_hardening = nodes.hardening_n_m2(i);
        const double edge_yield = (1 - share) * edges.yield_n_m(from) + share * edges.yield_n_m(to);
        const double edge_hardening =
            (1 - share) * edges.hardening_n_m2(from) + share * edges.hardening_n_m2(to);
        const bool node_may = facing > kLeastFacing;
        // First the weaker side alone, then both.
        double of_node_m = 0, of_edge_m = 0;
        bool both = false;
        if (node_may && force > node_yield && (node_yield <= edge_yield || force <= edge_yield)) {
            of_node_m = (force - node_yield) / (elastic + node_hardening);
            both = force - elastic * of_node_m > edge_yield;
        } else if (force > edge_yield) {
            of_edge_m = (force - edge_yield) / (elastic + edge_hardening);
            both = node_may && force - elastic * of_edge_m > node_yield;
        }
        if (both) {
            // force - k (a + b) = node_yield + h_n a = edge_yield + h_e b
            const double over_node = force - node_yield, over_edge = force - edge_yield;
            const double of_node = elastic + node_hardening, of_edge = elastic + edge_hardening;
            const double determinant = of_node * of_edge - elastic * elastic;
            of_node_m = (over_node * of_edge - elastic * over_edge) / determinant;
            of_edge_m = (of_node * over_edge - elastic * over_node) / determinant;
            if (of_node_m < 0) {
                of_node_m = 0;
                of_edge_m = std::max(0.0, over_edge / of_edge);
            } else if (of_edge_m < 0) {
                of_edge_m = 0;
                of_node_m = std::max(0.0, over_node / of_node);
            }
        }
        // Either side is pressed on twice: by its own nodes and by those of the other car.
        if (of_node_m > 0)
            m_increments.push_back({&nodes, i, 0.5 * of_node_m / std::max(facing, kLeastFacing)});
        if (of_edge_m > 0) {
            m_increments.push_back({&edges, from, 0.5 * of_edge_m * (1 - share)});
            m_increments.push_back({&edges, to, 0.5 * of_edge_m * share});
        }
        return force - elastic * (of_node_m + of_edge_m);
    }

    static Nearest nearest(const Outline& outline, const Point& point, double within_m) {
        Nearest best;
        double least_m2 = kFarM * kFarM;
        for (int edge = 0; edge < outline.size(); edge++) {
            const Point from = outline.crushed(edge), to = outline.crushed(outline.after(edge));
            if (std::abs(from.x - point.x) > within_m || std::abs(from.y - point.y) > within_m)
                continue;
            const Point along{to.x - from.x, to.y - from.y};
            const double length_m2 = along.x * along.x + along.y * along.y + 1e-18;
            const double share = std::clamp(
                ((point.x - from.x) * along.x + (point.y - from.y) * along.y) / length_m2, 0.0, 1.0);
            const double x = point.x - from.x - share * along.x, y = point.y - from.y - share * along.y;
            if (x * x + y * y < least_m2) {
                least_m2 = x * x + y * y;
                best.edge = edge;
                best.share = share;
            }
        }
        if (best.edge < 0)
            return best;
        const int edge = best.edge, next = outline.after(edge);
        // At a corner the mean normal of both edges says which side is inside.
        Point outward = edge_normal(outline, edge);
        if (best.share <= 0 || best.share >= 1) {
            const Point other = edge_normal(outline, best.share <= 0 ? outline.before(edge) : next);
            outward = {outward.x + other.x, outward.y + other.y};
        }
        const Point from = outline.crushed(edge), to = outline.crushed(next);
        const double x = point.x - from.x - best.share * (to.x - from.x);
        const double y = point.y - from.y - best.share * (to.y - from.y);
        const double distance_m = std::sqrt(least_m2);
        best.depth_m = x * outward.x + y * outward.y < 0 ? distance_m : -distance_m;
        // The normal changes smoothly along the outline.
        const Point one = node_normal(outline, edge), two = node_normal(outline, next);
        best.normal = unit({one.x + best.share * (two.x - one.x), one.y + best.share * (two.y - one.y)});
        return best;
    }

    static Point unit(const Point& of) {
        const double length = std::hypot(of.x, of.y);
        return {of.x / length, of.y / length};
    }
    static Point right_of(const Point& from, const Point& to) {
        return unit({to.y - from.y, -(to.x - from.x)});
    }
    static Point edge_normal(const Outline& outline, int edge) {
        return right_of(outline.crushed(edge), outline.crushed(outline.after(edge)));
    }
    static Point node_normal(const Outline& outline, int node) {
        return right_of(outline.crushed(outline.before(node)), outline.crushed(outline.after(node)));
    }

    Outline m_struck, m_striking;
    double m_elastic_n_m2, m_friction;
    std::vector<Increment> m_increments;
};
