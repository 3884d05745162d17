// First-order terms of gaps and forces in periodic cells, and second derivatives, against differences of packings that
// Newton's method makes; the checker's own terms too.
#include "checker/first_order.hpp"
#include "support/course.hpp"
#include "support/mirror_cells.hpp"
#include "support/newton.hpp"
#include "support/regular.hpp"
#include "support/scratch.hpp"
#include "verified/first_order.hpp"
#include "verified/precise_first_order.hpp"

#include <isostat/io/state_file.hpp>

using namespace isostat;
using namespace crafted;

namespace {

constexpr double step = 1e-4;

/// The packing near a state with these gaps of its contacts, in double.
Packing with_gaps(const State& state, const std::vector<double>& radius, std::size_t opened, double gap_of_it) {
    Packing packing = state.packing;
    packing.radius = radius;
    std::vector<double> gaps(state.contacts.size(), 0);
    gaps[opened] = gap_of_it;
    for (int newton = 0; newton < 8; ++newton) {
        step_to_gaps(packing, state.contacts, gaps);
    }
    return packing;
}

std::vector<double> forces_in(const State& state, const Packing& packing) {
    const auto structure = IsostaticStructure::prove(packing, state.contacts).value();
    std::vector<double> f = on_dofs(state.load.external_force(packing), structure.dofs());
    Factorisation(structure).solve_forces(f);
    return f;
}

std::vector<double> changed(const State& state, const std::vector<double>& rho, double eps) {
    std::vector<double> radius = state.packing.radius;
    for (std::size_t i = 0; i < rho.size(); ++i) {
        radius[i] += eps * rho[i];
    }
    return radius;
}

struct Derivatives {
    double first, second;
};
/// Of a function of s at 0.
Derivatives derivatives(const std::function<double(double)>& f) {
    const double after = f(step);
    const double before = f(-step);
    return {(after - before) / (2 * step), (after + before - 2 * f(0)) / (step * step)};
}

struct Vertex : crafted::Regular {
    explicit Vertex(const State& s)
        : Regular(s), enclosure(enclose_vertex(state.packing, structure, factorisation, inverse)),
          rho(tie_direction(state.packing.radius, 3)),
          first(state.packing, structure, factorisation, inverse, enclosure, rho),
          precise(state.packing, structure, factorisation, inverse, {}) {}
    VertexEnclosure enclosure;
    std::vector<double> rho;
    FirstOrder first;
    PreciseFirstOrder precise;
};

/// Vertices where pairs touch besides the contacts, through images too: the end of a tie of two gaps, with disks stored
/// a period away, and lattices.
std::vector<State> vertices_with_touching_pairs() {
    std::vector<State> vertices{follow_load(cells::mirror_pairs(), +1, 1, Ties::first_order, 1).states.back()};
    for (const bool tilts : {false, true}) {
        const State lattice = cells::loaded_lattice(3, 1, tilts);
        vertices.push_back(follow_load(lattice, +1, 1, Ties::choose, 1).states.front());
    }
    return vertices;
}

/// The middle of what the checker proves.
double middle(const checker::Range& range) {
    return (range.lower.get_d() + range.upper.get_d()) / 2;
}

bool near(double a, double b) {
    return std::abs(a - b) < 1e-5 * (1 + std::abs(b));
}

/// Every pair of disks through every image next to the cell that is no contact.
std::vector<Contact> other_pairs(const State& state) {
    std::vector<Contact> pairs;
    for (int i = 0; i < state.packing.disk_count(); ++i) {
        for (int j = i + 1; j < state.packing.disk_count(); ++j) {
            for (const int x : {-2, -1, 0, 1}) {
                pairs.push_back(cells::across(i, j, state.packing.cell.periodic[0] ? x : 0,
                                              state.packing.cell.periodic[1] ? 1 + x : 0));
            }
        }
    }
    return pairs;
}

} // namespace

BOOST_AUTO_TEST_CASE(gaps_and_forces_of_changed_radii_in_cells_are_those_of_packings_that_are_made,
                     *boost::unit_test::label("slow")) {
    for (const std::string name : {"tilt_16", "rect_16", "channel_16"}) {
        State state = read_any_state(scratch::data("cells/" + name + ".json")).state;
        snap_to_grid(state.packing);
        for (const LoadKind kind : {LoadKind::nominal, LoadKind::true_stress}) {
            state.load.kind = kind;
            const bool refused = kind == LoadKind::true_stress && state.packing.cell.tilt_moves[0];
            const Vertex at(state);
            std::vector<Enclosure> f0;
            for (const double f : forces_in(state, state.packing)) {
                f0.push_back({f, 1e-12});
            }
            const std::vector<Enclosure> f1 = at.first.forces(f0, std::vector<unsigned char>(f0.size(), 0), state.load);
            for (std::size_t l = 0; l < f1.size() && !refused; ++l) {
                const double f = derivatives([&](double eps) {
                                     const auto radius = changed(state, at.rho, eps);
                                     return forces_in(state, with_gaps(state, radius, 0, 0))[l];
                                 }).first;
                BOOST_TEST(near(f1[l].value, f),
                           name << " " << to_string(state.contacts[l]) << " " << f1[l].value << " " << f);
                BOOST_TEST(f1[l].radius < 1e-6);
            }
            for (const Contact& pair : other_pairs(state)) {
                const double h = derivatives([&](double eps) {
                                     return gap(with_gaps(state, changed(state, at.rho, eps), 0, 0), pair);
                                 }).first;
                BOOST_TEST(near(at.first.gap(pair).value, h), name << " " << to_string(pair));
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(rates_and_second_derivatives_of_pairs_that_touch_through_images_are_those_of_motions_that_are_made,
                     *boost::unit_test::label("slow")) {
    int images = 0;
    int bent = 0;
    for (const State& state : vertices_with_touching_pairs()) {
        Vertex at(state);
        const checker::Evidence evidence(state, CheckerArithmetic::automatic);
        const checker::Velocities velocities(evidence);
        for (const auto& [pair, c] : state.perturbation->open) {
            images += pair.image.is_here() ? 0 : 1;
            BOOST_TEST(near(at.precise.gap(at.rho, pair).value, at.first.gap(pair).value));
            for (std::size_t l = 0; l < state.contacts.size(); ++l) {
                const ContactId id(l);
                const Derivatives d =
                    derivatives([&](double s) { return gap(with_gaps(state, state.packing.radius, l, s), pair); });
                BOOST_TEST_CONTEXT(to_string(pair) << " when " << to_string(state.contacts[l]) << " opens") {
                    BOOST_TEST(near(at.first.rate(id, +1, pair).value, d.first));
                    BOOST_TEST(near(at.precise.rate(id, +1, pair).value, d.first));
                    BOOST_TEST(std::abs(at.precise.bend(id, +1, pair).value - d.second) <
                               1e-3 * (1 + std::abs(d.second)));
                    const auto motion = velocities.opening(l, +1);
                    BOOST_TEST(near(middle(velocities.gap_rate(pair, motion)), d.first));
                    const double bend = middle(velocities.bend(pair, l, motion));
                    BOOST_TEST(near(bend, at.precise.bend(id, +1, pair).value));
                }
                bent += !pair.image.is_here() && std::abs(d.second) > 0.1 ? 1 : 0;
            }
        }
        // Of a contact everything is known: its gap is 0, and that of the one that opens grows at unit rate.
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            const Contact& contact = state.contacts[l];
            BOOST_TEST(near(at.first.gap(contact).value, 0), to_string(contact));
            for (std::size_t opened = 0; opened < state.contacts.size(); ++opened) {
                const double rate = opened == l ? 1 : 0;
                BOOST_TEST(near(at.precise.rate(ContactId(opened), +1, contact).value, rate), to_string(contact));
            }
        }
    }
    BOOST_TEST(images > 5);
    BOOST_TEST(bent > 10);
}
