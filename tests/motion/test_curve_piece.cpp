// Tubes against a curve that is known: the centre of a unit disk on a fixed one moves on the circle of radius 2.
#include "contact/separation.hpp"
#include "core/dot.hpp"
#include "motion/curve_piece.hpp"
#include "motion/gap_watch.hpp"
#include "motion/power_watch.hpp"
#include "support/test.hpp"

#include <isostat/io/state_file.hpp>

using namespace isostat;

namespace {

/// Disk 1 free at `angle` on disk 0, which is fixed, and `off` from touching it: so far the curve is from the
/// polynomial; `axis` of disk 1 in the free row. Disk 2, if any, is fixed too.
struct OnCircle {
    Packing packing;
    std::unique_ptr<ArcCentre> centre;
    std::optional<KeptCurve> curve;

    OnCircle(double angle, int axis, double off = 0, std::array<double, 3> obstacle = {}) {
        packing.walls = Walls::none();
        packing.radius = {1, 1};
        packing.q = {0, 0, (2 + off) * std::cos(angle), (2 + off) * std::sin(angle), 0, 0};
        packing.fixed = {1, 0};
        if (obstacle[2] > 0) {
            packing.q.insert(packing.q.end() - 2, {obstacle[0], obstacle[1]});
            packing.radius.push_back(obstacle[2]);
            packing.fixed.push_back(1);
        }
        snap_to_grid(packing);
        const std::vector<Contact> contacts{{ContactKind::disk_disk, 0, 1}, {ContactKind::held, 2 + axis, 0}};
        InverseBoundCache cache;
        centre = ArcCentre::make(packing, contacts, cache);
        BOOST_REQUIRE(centre != nullptr);
        curve.emplace(packing, contacts, 1, 0.0);
    }
    CurvePiece piece() { return {*curve, *centre, 1}; }
};

} // namespace

BOOST_AUTO_TEST_CASE(the_true_curve_lies_in_the_tube_and_its_tangent_within_the_bound) {
    for (const double angle : {0.3, 0.8, 1.2, 2.5}) {
        OnCircle on(angle, 0);
        CurvePiece piece = on.piece();
        const double h = 0.5 * piece.natural_reach();
        BOOST_TEST_REQUIRE(piece.prove(h));
        BOOST_TEST(piece.radius() < 1e-13);
        BOOST_TEST(piece.unique() > 1e3 * piece.radius());
        for (int k = -10; k <= 10; ++k) {
            const double s = 0.1 * k * h;
            const auto p = piece.point(s);
            const auto v = piece.slope(s);
            // x = that of p, on the circle about disk 0.
            const long double x = p[2];
            const long double y = std::sqrt(4 - x * x);
            const double rounding = 1e-15;
            BOOST_TEST(std::abs(static_cast<double>(y - p[3])) <= piece.radius() + rounding);
            BOOST_TEST(std::abs(static_cast<double>(-x / y * v[2] - v[3])) <= piece.slope_error() + rounding);
        }
    }
}

BOOST_AUTO_TEST_CASE(no_tube_is_proved_across_a_point_where_the_row_turns) {
    // x = 2 cos(angle) has its largest value at angle 0; s runs like the faster coordinate y, 0.1 away from there.
    OnCircle on(0.05, 0);
    CurvePiece piece = on.piece();
    const double ahead = on.packing.q[3];
    BOOST_TEST(piece.natural_reach() < ahead);
    for (const double share : {1.001, 1.5, 4.0}) {
        BOOST_TEST(!piece.prove(share * ahead));
    }
    BOOST_TEST(piece.prove(0.2 * piece.natural_reach()));
    OnCircle other(0.05, 1); // y does not turn there
    CurvePiece upward = other.piece();
    BOOST_TEST(upward.prove(0.12));
    BOOST_TEST(upward.slope(-0.12)[2] * upward.slope(0.12)[2] < 0); // x does
}

BOOST_AUTO_TEST_CASE(points_are_located_on_their_own_curve_only) {
    OnCircle on(0.8, 0);
    CurvePiece piece = on.piece();
    BOOST_TEST_REQUIRE(piece.prove(0.5 * piece.natural_reach()));
    const double s = 0.3 * piece.reach();
    std::vector<double> x = piece.point(s);
    x[3] = std::sqrt(4 - x[2] * x[2]);
    const auto place = required(piece.locate(x, 1e-15));
    BOOST_TEST(std::abs(place.s - s) <= place.slack);
    BOOST_TEST(place.slack < 1e-12);
    x[3] = -x[3]; // on the circle, at the same x, on the other side
    BOOST_TEST(!piece.locate(x, 1e-15).has_value());
    x[3] = -x[3];
    BOOST_TEST(!piece.locate(x, 1.0).has_value()); // nobody knows where
    x = piece.point(piece.reach() * 1.01);
    BOOST_TEST(!piece.locate(x, 1e-15).has_value()); // beyond what was proved
}

BOOST_AUTO_TEST_CASE(a_bound_of_the_inverse_that_is_not_there_proves_no_tube) {
    OnCircle on(0.8, 0);
    const InverseBound unknown;
    const VertexEnclosure enclosure;
    const auto centre =
        ArcCentre::of({on.packing, on.centre->structure(), on.centre->factorisation(), unknown, enclosure});
    CurvePiece piece(*on.curve, *centre, 1);
    BOOST_TEST(!piece.prove(1e-6));
    BOOST_TEST(on.piece().prove(1e-6));
}

BOOST_AUTO_TEST_CASE(the_constants_of_a_tube_are_those_of_the_statements) {
    const auto within = [](double value, double least, double slack) {
        BOOST_TEST(value >= least * (1 - 1e-12), value << " is below " << least);
        BOOST_TEST(value <= least * (1 + slack), value << " is far above " << least);
    };
    // K of V4 over the kept contacts, and what grains at rest add (A7).
    const State state = read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state;
    for (const std::size_t slot : {0U, 17U, 101U}) {
        std::vector<int> count(state.packing.radius.size(), 0);
        double smallest = 1e300;
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            const Contact& c = state.contacts[l];
            if (l != slot && c.kind == ContactKind::disk_disk) {
                const auto i = static_cast<std::size_t>(c.i);
                const auto j = static_cast<std::size_t>(c.j);
                ++count[i];
                ++count[j];
                smallest = std::min(smallest, state.packing.radius[i] + state.packing.radius[j]);
            }
        }
        const KeptCurve curve(state.packing, state.contacts, slot, 1e-9);
        within(curve.lipschitz, 2 * std::sqrt(*std::ranges::max_element(count)) / smallest, 1e-8);
        BOOST_TEST(curve.rest_residual == 0); // all of them move
    }
    OnCircle on(0.8, 0);
    const KeptCurve curve(on.packing, {{ContactKind::disk_disk, 0, 1}, {ContactKind::held, 2, 0}}, 1, 1e-9);
    within(curve.rest_residual, 1e-9, 0.02);
    within(curve.rest_derivative, 1e-9 / 2, 0.02);
    // A1, A2 at the centre itself, a thousandth of a radius off the curve: h is next to nothing there.
    OnCircle off(0.8, 0, 1e-3);
    CurvePiece piece = off.piece();
    BOOST_TEST_REQUIRE(piece.prove(1e-9));
    const double ratio = 1e-3 / 2;
    const double beta = (1 + 2 * ratio) / off.centre->sigma_min();
    const double residual = (2.001 * 2.001 - 4) / 4;
    within(1 / (piece.unique() * off.curve->lipschitz), beta, 1e-4);
    within(piece.radius(), 2 * beta * residual, 1e-2);
    within(0.25 / piece.margin(), beta * beta * off.curve->lipschitz * residual, 1e-2);
}

// C11, written down once more: sums over the contacts of a disk, and over those with an image.
BOOST_AUTO_TEST_CASE(the_constants_of_a_curve_in_a_cell_are_those_of_the_statement) {
    for (const char* name : {"tilt_16", "rect_16", "channel_16"}) {
        const State state = read_any_state(std::string(ISOSTAT_TEST_DATA) + "/cells/" + name + ".json").state;
        const Packing& packing = state.packing;
        const std::size_t slot = 3;
        const KeptCurve curve(packing, state.contacts, slot, 0.0);
        std::vector<double> squares(packing.radius.size() + 1, 0.0);
        std::vector<double> fourths = squares;
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            const Contact& c = state.contacts[l];
            if (l == slot || c.kind != ContactKind::disk_disk) {
                continue;
            }
            const double m = std::hypot(c.image.m[0], c.image.m[1]);
            const double w = (c.i == c.j ? 0 : 2) + m * m;
            const double d =
                packing.radius[static_cast<std::size_t>(c.i)] + packing.radius[static_cast<std::size_t>(c.j)];
            const auto add = [&](std::size_t block) {
                squares[block] += w;
                fourths[block] += w * w / (d * d);
            };
            for (const int disk : {c.i, c.j}) {
                if (c.i != c.j) {
                    add(static_cast<std::size_t>(disk));
                }
            }
            if (m > 0) {
                add(packing.radius.size());
            }
        }
        const auto within = [](double value, double least) {
            BOOST_TEST((value >= least && value <= least * (1 + 1e-6)), value << " against " << least);
        };
        within(curve.spread, *std::ranges::max_element(squares));
        within(curve.lipschitz, std::sqrt(*std::ranges::max_element(fourths)));
        // No matrix with such rows is larger than norm_of says: here those of the normals at this place.
        std::vector<double> e(state.contacts.size(), 0.0);
        std::vector<double> x(packing.q.size(), 1.0);
        double largest = 0;
        for (int round = 0; round < 200; ++round) {
            std::vector<double> next(x.size(), 0.0);
            for (std::size_t l = 0; l < e.size(); ++l) {
                if (!curve.bends(l)) {
                    continue;
                }
                e[l] = 1.0 / (1.0 + static_cast<double>(l % 3));
                const GapGradient g = gap_gradient(packing, state.contacts[l]);
                double y = 0;
                for (int k = 0; k < g.count; ++k) {
                    const auto entry = static_cast<std::size_t>(k);
                    y += e[l] * g.value[entry] * x[static_cast<std::size_t>(g.coordinate[entry])];
                }
                for (int k = 0; k < g.count; ++k) {
                    const auto entry = static_cast<std::size_t>(k);
                    next[static_cast<std::size_t>(g.coordinate[entry])] += e[l] * g.value[entry] * y;
                }
            }
            const double length = euclidean_norm(next);
            largest = std::sqrt(length);
            for (double& c : next) {
                c /= length;
            }
            x = next;
        }
        BOOST_TEST(curve.norm_of(e) >= largest);
        BOOST_TEST(curve.norm_of(e) <= 2 * largest);
    }
}

// The polynomial clears the obstacle, the curve runs into it.
BOOST_AUTO_TEST_CASE(a_gap_of_the_polynomial_within_the_tube_proves_nothing) {
    constexpr double off = 1e-6;
    for (const double angle : {0.8, 1.2, 2.2}) {
        const double x = (2 + off) * std::cos(angle);
        const double on_curve = std::acos(x / 2); // the angle of the point of the curve with the same x
        for (const double clearance : {-0.3 * off, 10 * off}) {
            const double place = 2 - (1.25 + clearance); // towards disk 0, where the gap does not change at first order
            OnCircle on(angle, 0, off, {place * std::cos(on_curve), place * std::sin(on_curve), 0.25});
            CurvePiece piece = on.piece();
            const double h = 1e-9;
            BOOST_TEST_REQUIRE(piece.prove(h));
            const Contact obstacle{ContactKind::disk_disk, 1, 2};
            BOOST_TEST(gap(on.packing, obstacle) > 0.5 * off);
            GapWatch watch;
            BOOST_TEST(watch.look(piece, obstacle, -h, h) == (clearance > 0));
        }
    }
}

// Seen from a disk far away the curve goes one way, the polynomial the other.
BOOST_AUTO_TEST_CASE(a_rate_of_the_polynomial_within_its_error_proves_nothing) {
    constexpr double off = 1e-6, far = 1000;
    for (const double angle : {0.8, 1.1}) {
        const double x = (2 + off) * std::cos(angle);
        const double on_curve = std::acos(x / 2); // the angle of the point of the curve with the same x
        for (const double side : {-1.0, 1.0}) {
            for (const double turn : {0.0, 0.1}) {
                const double line = 0.5 * (angle + on_curve) + side * turn;
                OnCircle on(angle, 0, off, {x + far * std::cos(line), 2 * std::sin(angle) + far * std::sin(line), 1});
                CurvePiece piece = on.piece();
                BOOST_TEST_REQUIRE(piece.prove(1e-9));
                const std::vector<double> v = piece.slope(0);
                // The gap grows where the disk moves against the line.
                const auto rate = [&](double direction) {
                    const double sense = v[2] * -std::sin(direction) > 0 ? 1 : -1;
                    const double along = -std::sin(direction) * std::cos(line) + std::cos(direction) * std::sin(line);
                    return -sense * along;
                };
                const int sign = GapWatch::rate_sign(piece, {ContactKind::disk_disk, 1, 2}, 0);
                if (turn == 0) {
                    BOOST_TEST(rate(angle) * rate(on_curve) < 0);
                    BOOST_TEST(sign == 0);
                } else {
                    BOOST_TEST(sign == (rate(on_curve) > 0 ? 1 : -1));
                }
            }
        }
    }
}

// A load across the direction of motion: positive power along the polynomial, negative along the curve.
BOOST_AUTO_TEST_CASE(a_power_of_the_polynomial_within_its_error_proves_nothing) {
    constexpr double off = 1e-6;
    const double angle = 0.8;
    const double on_curve = std::acos((2 + off) * std::cos(angle) / 2);
    for (const double turn : {-0.1, 0.0, 0.1}) {
        OnCircle on(angle, 0, off);
        CurvePiece piece = on.piece();
        BOOST_TEST_REQUIRE(piece.prove(1e-9));
        const double line = 0.5 * (angle + on_curve) + turn;
        const std::vector<double> v = piece.slope(0);
        const double sense = v[2] * std::cos(line) + v[3] * std::sin(line) > 0 ? 1 : -1;
        Load load;
        load.disk_force = {0, 0, sense * std::cos(line), sense * std::sin(line)};
        BOOST_TEST(v[2] * load.disk_force[2] + v[3] * load.disk_force[3] > 0);
        const PowerLoad given{&load, false, false};
        PowerWatch watch(given);
        watch.look(piece, -1e-9, 1e-9);
        ArcCertificate certificate;
        watch.conclude(certificate, false);
        BOOST_TEST((certificate.power == Verdict::proved) == (turn != 0));
    }
}

/// Newton's method in long double from `q` to a root of the equations of all contacts but one, whose row stays.
void to_the_curve(const KeptCurve& curve, const ArcCentre& centre, std::vector<long double>& q) {
    const auto minus = [](long double a, long double b) -> long double { return a - b; };
    const DofMap& dofs = centre.structure().dofs();
    for (int round = 0; round < 8; ++round) {
        std::vector<double> step(curve.contacts.size(), 0.0);
        for (std::size_t l = 0; l < step.size(); ++l) {
            const Contact& c = curve.contacts[l];
            if (l == curve.slot) {
                continue;
            }
            const auto r =
                Separation(c, centre.packing().layout()).of_disks([&](std::size_t k) { return q[k]; }, minus);
            const auto& radius = centre.packing().radius;
            const long double d =
                static_cast<long double>(radius[static_cast<std::size_t>(c.i)]) + radius[static_cast<std::size_t>(c.j)];
            step[l] = static_cast<double>((r[0] * r[0] + r[1] * r[1] - d * d) / (2 * d));
        }
        centre.factorisation().solve_velocities(step);
        dofs.move(q, step);
    }
}

// The tube is around p + a_0, and its radius is counted from p: neither may be forgotten.
BOOST_AUTO_TEST_CASE(the_true_curve_of_a_cell_lies_in_the_tube_of_a_shifted_polynomial) {
    for (const char* name : {"tilt_16", "rect_16"}) {
        for (const double off : {0.0, 0x1p-30, 0x1p-15}) { // how far the centre is from the curve, besides its rounding
            State state = read_any_state(std::string(ISOSTAT_TEST_DATA) + "/cells/" + name + ".json").state;
            for (std::size_t k = 2; k < state.packing.q.size(); k += 3) {
                state.packing.q[k] += off;
            }
            snap_to_grid(state.packing);
            const std::size_t slot = 3;
            InverseBoundCache cache;
            const auto centre = ArcCentre::make(state.packing, state.contacts, cache);
            BOOST_TEST_REQUIRE((centre != nullptr));
            const KeptCurve curve(state.packing, state.contacts, slot, 0.0);
            CurvePiece piece(curve, *centre, 1);
            BOOST_TEST_REQUIRE(piece.shift().size() == state.packing.q.size());
            const double shift = euclidean_norm(piece.shift());
            for (const double part : {1.0, 0.05, 1e-7}) {
                const double h = part * piece.natural_reach();
                BOOST_TEST_REQUIRE(piece.prove(h));
                double farthest = 0, shifted = 0;
                for (const double share : {-1.0, -0.4, 0.0, 0.3, 1.0}) {
                    std::vector<long double> p(state.packing.q.begin(), state.packing.q.end());
                    std::vector<long double> q = p;
                    for (std::size_t k = 0; k < p.size(); ++k) {
                        long double sum = 0;
                        for (std::size_t order = piece.coefficients().size(); order > 0; --order) {
                            sum = (sum + piece.coefficients()[order - 1][k]) * (share * h);
                        }
                        p[k] += sum;
                        q[k] += sum + piece.shift()[k];
                    }
                    const std::vector<long double> middle = q;
                    to_the_curve(curve, *centre, q);
                    long double square = 0, around = 0;
                    for (std::size_t k = 0; k < p.size(); ++k) {
                        square += (q[k] - p[k]) * (q[k] - p[k]);
                        around += (q[k] - middle[k]) * (q[k] - middle[k]);
                    }
                    const double rounding = 1e-17; // of long double at 16
                    BOOST_TEST(static_cast<double>(std::sqrt(square)) <= piece.radius() + rounding);
                    BOOST_TEST(static_cast<double>(std::sqrt(around)) <= piece.radius() - shift + rounding);
                    farthest = std::max(farthest, static_cast<double>(std::sqrt(square)));
                    shifted = std::max(shifted, static_cast<double>(std::sqrt(around)));
                }
                // The reach is such that p + a_0 misses the equations by a sixteenth of what the centre does; near the
                // centre by next to nothing, what remains is a_0.
                const double loose = part < 1 ? 1.05 : 4;
                BOOST_TEST(piece.radius() < loose * farthest + 1e-13, piece.radius() << " for " << farthest);
                BOOST_TEST(shifted < 0.1 * farthest, shifted << " of " << farthest);
            }
        }
    }
}
