#include "certificate/jammed_box.hpp"
#include "certificate/parts.hpp"
#include "contact/contact_set.hpp"
#include "contact/other_pairs.hpp"

#include <isostat/certificate/certify.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <set>

namespace isostat {

namespace {

/// The true vertex with every strain of its cell, under a pressure: N = N_f of full strain, h = k = 0 (C7).
State strained(State state, const std::vector<Contact>& own) {
    state.packing.cell.keeps_shape = false;
    state.packing.cell.move(true, true);
    if (!own.empty()) { // the others move as it does: they are as wide, along the same period
        state.contacts.push_back(own.front());
    }
    const std::vector<double> infinitesimal = state.load.infinitesimal;
    state.load = {};
    state.load.dimension = state.packing.dimension;
    std::fill_n(state.load.stress.begin(), state.packing.dimension, 1);
    state.load.infinitesimal = infinitesimal;
    state.load.refer_to(state.packing);
    return state;
}

/// The forces of the contacts under stresses that are a pressure for some lengths within `radius` of the stored ones:
/// as these over the true ones, that along x being 1 (a factor changes no sign). Forces are affine in every stress, so
/// they lie between those of the corners. Nothing where a corner is not known.
std::vector<std::vector<Interval>> pressed(State state, double radius) {
    constexpr double rounded = 0x1p-48; // cells.md C7, roundings of a stress at a corner
    const double x = state.packing.length(0);
    state.load.path.reset();
    std::vector<PerAxis<double>> corners(1U << (state.packing.axes() - 1), state.load.stress);
    for (unsigned corner = 0; corner < corners.size(); ++corner) {
        for (std::size_t a = 1; a < state.packing.axes(); ++a) {
            const double length = state.packing.lattice(a, a);
            const bool high = (corner >> (a - 1) & 1U) != 0;
            if (!(2 * radius < length)) { // C7
                return {};
            }
            corners[corner][a] = high ? (1 + radius / x) / (1 - radius / length) * (1 + rounded)
                                      : (1 - radius / x) / (1 + radius / length) * (1 - rounded);
        }
    }
    return finite_forces(std::move(state), corners);
}

/// The forces under an isotropic pressure are unique and say whether it is jammed strictly. It is a pressure where the
/// stresses are as the stored lengths over the true ones, which are known to the radius.
JammingAnswer strictly(const State& state, const std::vector<unsigned char>& zero, double radius) {
    const std::vector<std::vector<Interval>> corners = pressed(state, radius);
    if (corners.empty()) {
        return {Verdict::undecided, "k = 0 for full strain; its forces under an isotropic pressure are not known"};
    }
    JammingAnswer out{Verdict::proved,
                      "k = 0 for full strain, and every force of the backbone is positive under an isotropic pressure"};
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const auto every = [&](auto test) {
            return std::ranges::all_of(corners, [&](const auto& forces) { return test(forces[l]); });
        };
        const std::string name = to_string(state.contacts[l], state.packing.dimension);
        if (every([](const Interval& f) { return f.upper < 0; })) {
            return {Verdict::refuted, fmt::format("the force of {} is negative under an isotropic pressure: it opens "
                                                  "alone while the volume falls",
                                                  name)};
        }
        if ((l >= zero.size() || zero[l] == 0) && !every([](const Interval& f) { return f.lower > 0; })) {
            out = {Verdict::undecided,
                   fmt::format("k = 0 for full strain; the force of {} under an isotropic pressure may be 0", name)};
        }
    }
    return out;
}

/// Along so many periods do grains touch images of their own.
int periods_of(const std::vector<Contact>& own) {
    std::set<Image> images;
    std::ranges::transform(own, std::inserter(images, images.end()), [](const Contact& pair) { return pair.image; });
    return static_cast<int>(images.size());
}

/// An isostatic equilibrium has no mechanism while its own cell moves, so none while the cell stays (C6). What its own
/// contacts leave of full strain, own images may close (C7). \p own: those of the backbone; \p others: of rattlers.
void judge(const State& state, const Certification& truth, const std::vector<Contact>& own,
           const std::vector<Contact>& others, CellInspection& out) {
    const auto moving = std::ranges::count(state.packing.cell.period_moves, true) +
                        std::ranges::count(state.packing.cell.tilt_moves, true);
    const int missing = strain_count(Strain::full, state.packing.dimension) - static_cast<int>(moving);
    const int closed = periods_of(own); // in space up to 2, and then more are missing
    out.collective = {Verdict::proved, "positive forces, and no mechanism: k = 0 at the true vertex"};
    out.local = {Verdict::proved, "it is jammed collectively"};
    if (missing == closed) {
        out.strict = strictly(strained(state, own), truth.structural_zero, truth.claims.vertex->radius);
    } else if (missing == 1 && !others.empty()) {
        out.strict = {Verdict::undecided, fmt::format("N is 1 short of N_f for full strain, and a rattler touches its "
                                                      "own image ({})",
                                                      to_string(others.front(), state.packing.dimension))};
    } else {
        out.strict = {Verdict::refuted,
                      fmt::format("N is {} short of N_f for full strain{}: a strain of the cell keeps every contact "
                                  "from closing while the volume does not grow",
                                  missing - closed, own.empty() ? "" : ", own images that touch counted")};
    }
}

/// With the own images of disks of the list that touch.
std::vector<Contact> joined(std::vector<Contact> contacts, const std::vector<Contact>& own) {
    contacts.insert(contacts.end(), own.begin(), own.end());
    return contacts;
}

/// Own images that touch and are not in the list.
std::vector<Contact> own_besides(const Packing& packing, const std::vector<Contact>& contacts) {
    std::vector<Contact> own = touching_own_images(packing);
    std::erase_if(own, [&](const Contact& pair) { return std::ranges::find(contacts, pair) != contacts.end(); });
    return own;
}

/// Both walls on every axis, and none of the upper ones moves.
enum class Box : unsigned char { none, moves, stays };
Box box_of(const Packing& packing) {
    bool walls = !packing.cell.any(), moves = false;
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        walls = walls && packing.walls.lower[a] != WallKind::absent && packing.walls.upper[a] != WallKind::absent;
        moves = moves || packing.walls.upper[a] == WallKind::movable;
    }
    return !walls ? Box::none : moves ? Box::moves : Box::stays;
}

bool is_equilibrium(const Certification& truth) {
    return truth.claims.vertex && truth.claims.forces && truth.claims.gaps && truth.signs.positive > 0;
}

/// The size of the box gives way: forces in walls that stay are then determined up to a factor.
State with_size(State state) {
    state.packing.walls.upper[state.packing.axes() - 1] = WallKind::movable;
    const int dimension = state.packing.dimension;
    state.load = {};
    state.load.dimension = dimension;
    state.load.loaded_axis = dimension - 1;
    std::fill_n(state.load.stress.begin(), dimension, 1);
    state.load.refer_to(state.packing);
    return state;
}

} // namespace

std::optional<BoxInspection> inspect_box(const State& state, const Certification& truth) {
    const Box box = box_of(state.packing);
    const auto any = [](const auto& values) {
        return std::ranges::any_of(values, [](const auto& value) { return value != 0; });
    };
    const bool holds =
        std::ranges::any_of(state.contacts, [](const Contact& c) { return c.kind == ContactKind::held; });
    const bool clumps = !state.packing.bars.empty(); // what their rattlers are is told by forces
    if (clumps || box == Box::none || any(state.packing.fixed) || any(state.load.disk_force) || holds) {
        return std::nullopt;
    }
    const std::vector<int> rattlers = rattlers_by_coordination(state.packing, state.contacts);
    State rest = state;
    rest.packing = without_disks(state.packing, rattlers);
    const auto rattles = [&](int i) { return std::ranges::binary_search(rattlers, i); };
    std::erase_if(rest.contacts, [&](const Contact& c) { return rattles(c.i) || (c.of_disks() && rattles(c.j)); });
    BoxInspection out;
    out.grains = state.packing.disk_count() - static_cast<int>(rattlers.size());
    Packing held = rest.packing;
    std::fill_n(held.walls.upper.begin(), held.axes(), WallKind::fixed);
    out.counting = count_contacts(held, rest.contacts);
    const Counting& c = out.counting;
    if (box == Box::moves ? is_equilibrium(truth) : c.hyperstaticity == 1 && is_equilibrium(certify(with_size(rest)))) {
        out.collective = {Verdict::proved, "positive forces, and no mechanism: k = 0 at the true vertex"};
    } else if (box == Box::stays && c.hyperstaticity > 1) {
        out.collective.reason =
            fmt::format("h = {} of {} {}s that are no rattlers: {} contact{} more than the size of "
                        "the box and the places determine, "
                        "which doubles cannot prove to close (exact numbers can, in TOML)",
                        c.hyperstaticity, out.grains, state.packing.dimension == plane ? "disk" : "sphere",
                        c.hyperstaticity - 1, c.hyperstaticity == 2 ? "" : "s");
    } else {
        out.collective.reason = fmt::format("no equilibrium is proved; h = {}, k = {} of the {} that are no rattlers",
                                            c.hyperstaticity, c.mechanisms, out.grains);
    }
    if (box == Box::stays && out.collective.verdict == Verdict::undecided) {
        out.collective.if_closed = jammed_if_closed(held, rest.contacts).collective;
    }
    return out;
}

void add_if_closed(const Packing& packing, const std::vector<Contact>& contacts, CellInspection& cell) {
    const IfClosed seen = jammed_if_closed(packing, joined(contacts, own_besides(packing, contacts)));
    cell.collective.if_closed = seen.collective;
    cell.strict.if_closed = seen.strict;
    if (seen.collective && seen.collective->verdict == Verdict::proved) {
        cell.local.if_closed = seen.collective;
    }
}

CellInspection inspect_cell(const State& state, const Certification& truth) {
    assert(state.packing.cell.all());
    CellInspection out;
    out.dimension = state.packing.dimension;
    std::vector<Contact> own = own_besides(state.packing, state.contacts);
    out.all = count_strains(state.packing, joined(state.contacts, own));
    const bool equilibrium = truth.claims.vertex && truth.claims.forces && truth.claims.gaps;
    const auto& on_disks = state.load.disk_force;
    const bool loaded = std::ranges::any_of(on_disks, [](double f) { return f != 0; });
    if (!equilibrium || loaded) {
        const JammingAnswer unknown{Verdict::undecided,
                                    loaded ? "forces on disks: no self-stress is known"
                                           : "no equilibrium of this state is proved: the counts alone do "
                                             "not tell"};
        out.local = out.collective = out.strict = unknown;
        if (!loaded) {
            add_if_closed(state.packing, state.contacts, out);
        }
        return out;
    }
    const std::vector<Contact> carrying = unmarked(state.contacts, truth.structural_zero);
    const std::vector<int> rattlers = untouched(state.packing.disk_count(), carrying);
    out.backbone_disks = state.packing.disk_count() - static_cast<int>(rattlers.size());
    if (out.backbone_disks > 0) {
        const auto rattling = std::stable_partition(own.begin(), own.end(), [&](const Contact& pair) {
            return std::ranges::find(rattlers, pair.i) == rattlers.end();
        });
        const std::vector<Contact> others(rattling, own.end());
        own.erase(rattling, own.end());
        out.backbone = count_strains(without_disks(state.packing, rattlers), joined(carrying, own));
        judge(state, truth, own, others, out);
    }
    return out;
}

} // namespace isostat
