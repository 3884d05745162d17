#include "crafted/inspection_parts.hpp"

#include "contact/separation.hpp"
#include "crafted/able.hpp"

#include <algorithm>
#include <functional>

namespace isostat::crafted {

namespace {

ExactPacking without_rattlers(const ExactPacking& packing, const std::vector<DiskHold>& hold) {
    ExactPacking out = packing;
    out.load.reset();
    out.radius.clear();
    out.centre.clear();
    out.fixed.clear();
    out.cell.pin = 0;
    for (std::size_t i = 0; i < hold.size(); ++i) {
        if (hold[i] != DiskHold::rattler) {
            out.radius.push_back(packing.radius[i]);
            out.centre.push_back(packing.centre[i]);
        }
    }
    return out;
}

/// Refuted when a motion keeps every gap (`mechanisms`) or opens some and closes none (no `positive` forces).
Verdict jammed(const Inspection& seen, bool decided, bool positive) {
    if (seen.rank_exact == Verdict::proved && seen.mechanisms > 0) {
        return Verdict::refuted;
    }
    return seen.rank_exact != Verdict::proved || !decided ? Verdict::undecided
           : positive                                     ? Verdict::proved
                                                          : Verdict::refuted;
}

using Vectors = std::vector<std::vector<Number>>;

/// The largest t, by the dual: least f y with y >= 0, change y = -1, stresses y = 0. Empty: t is not bounded.
std::optional<Number> largest(const std::vector<Number>& forces, const Vectors& rows) {
    std::vector<Number> b(rows.size());
    b[0] = -1;
    return exact::least(rows, b, forces);
}

/// The contacts whose force vanishes at f + t change.
std::vector<int> zeros(const std::vector<Number>& forces, const std::vector<Number>& change, const Number& t) {
    std::vector<int> out;
    for (std::size_t l = 0; l < forces.size(); ++l) {
        if (!change[l].is_zero() && (forces[l] + t * change[l]).is_zero()) {
            out.push_back(static_cast<int>(l));
        }
    }
    return out;
}

} // namespace

Jamming judge_jamming(const ExactPacking& packing, const std::vector<DiskHold>& hold, const InspectionLimits& limits) {
    ExactPacking rest = without_rattlers(packing, hold);
    Jamming out;
    out.disks = rest.disk_count();
    if (out.disks == 0) {
        out.collective = Verdict::refuted;
        out.strict = packing.cell.any() ? std::optional(Verdict::refuted) : std::nullopt;
        return out;
    }
    const auto inspected = [&](bool moves) {
        rest.cell.move(moves, moves);
        return inspect_contacts(rest, exact_contacts(rest).value(), limits);
    };
    const Inspection fixed = inspected(false);
    out.collective = fixed.dof_count == 0
                         ? Verdict::proved
                         : jammed(fixed, fixed.one_sign_decided, fixed.one_sign.kind == exact::OneSign::strict);
    if (!packing.cell.any()) {
        return out;
    }
    rest.load.emplace(); // a pressure of 1, so that the load is minus the derivative of the volume
    for (std::size_t a = 0; a < rest.axes(); ++a) {
        rest.load->wall[a] = 1;
        for (std::size_t b = 0; b < rest.axes(); ++b) {
            rest.load->wall[a] *= b == a ? Number(1) : rest.length[b];
        }
    }
    const Inspection strained = inspected(true);
    out.strict = jammed(strained, strained.support != Support::undecided, strained.support == Support::positive);
    return out;
}

std::optional<LoadRange> load_range(const std::vector<Number>& forces, const std::vector<Number>& change,
                                    const Vectors& stresses) {
    // Farkas: no t is supported exactly when some y >= 0 has f y = -1, change y = 0 and stresses y = 0.
    Vectors rows{change};
    rows.insert(rows.end(), stresses.begin(), stresses.end());
    for (std::vector<Number>& row : rows) { // the forces after these may have any sign
        row.resize(forces.size());
    }
    Vectors all = rows;
    all.push_back(forces);
    std::vector<Number> b(all.size());
    b.back() = -1;
    if (exact::feasible_point(all, b, static_cast<int>(forces.size())).feasible) {
        return std::nullopt;
    }
    LoadRange out;
    out.most = largest(forces, rows);
    std::ranges::transform(rows[0], rows[0].begin(), std::negate());
    if (const auto back = largest(forces, rows)) {
        out.least = -*back;
    }
    if (stresses.empty()) {
        out.zero_at_least = out.least ? zeros(forces, change, *out.least) : std::vector<int>{};
        out.zero_at_most = out.most ? zeros(forces, change, *out.most) : std::vector<int>{};
    }
    return out;
}

Inertia inertia(std::vector<std::vector<Number>> a) {
    Inertia out;
    std::vector<std::size_t> left(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        left[i] = i;
    }
    while (!left.empty()) {
        std::size_t pivot = left.size();
        for (std::size_t s = 0; s < left.size() && pivot == left.size(); ++s) {
            pivot = a[left[s]][left[s]].is_zero() ? pivot : s;
        }
        if (pivot == left.size()) {
            // No diagonal entry is left: adding row and column j to i turns x_i x_j into a square.
            std::size_t s = 0, t = 0;
            bool found = false;
            for (std::size_t u = 0; u < left.size() && !found; ++u) {
                for (std::size_t v = u + 1; v < left.size() && !found; ++v) {
                    found = !a[left[u]][left[v]].is_zero();
                    s = u;
                    t = v;
                }
            }
            if (!found) {
                out.zero += static_cast<int>(left.size());
                return out;
            }
            for (const std::size_t k : left) {
                a[left[s]][k] += a[left[t]][k];
            }
            for (const std::size_t k : left) {
                a[k][left[s]] += a[k][left[t]];
            }
            pivot = s;
        }
        const std::size_t p = left[pivot];
        (a[p][p].sign() > 0 ? out.positive : out.negative) += 1;
        const Number scale = a[p][p].inverse();
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(pivot));
        for (const std::size_t i : left) {
            const Number factor = a[i][p] * scale;
            for (const std::size_t j : left) {
                a[i][j] -= factor * a[p][j];
            }
        }
    }
    return out;
}

std::vector<std::vector<Number>> stress_form(const ExactPacking& packing, const DofMap& dofs,
                                             const std::vector<Contact>& contacts, const std::vector<Number>& forces,
                                             const std::vector<std::vector<Number>>& motions) {
    const std::size_t k = motions.size();
    std::vector<std::vector<Number>> out(k, std::vector<Number>(k));
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& contact = contacts[l];
        if (!contact.of_disks() || forces[l].is_zero()) {
            continue; // a wall's gap is linear
        }
        const Separation separation(contact, packing.layout());
        std::vector<PerAxis<Number>> relative(k);
        for (std::size_t m = 0; m < k; ++m) {
            const auto velocity = [&](std::size_t coordinate) {
                const int dof = dofs.dof_of(coordinate);
                return dof < 0 ? Number() : motions[m][static_cast<std::size_t>(dof)];
            };
            relative[m] = separation.of_disks(velocity, std::minus<>());
        }
        const Number weight = forces[l] / scale_of_row(packing, contact);
        for (std::size_t a = 0; a < k; ++a) {
            for (std::size_t b = 0; b < k; ++b) {
                const Number product = dot(relative[a], relative[b]);
                if (!product.is_zero()) {
                    out[a][b] += weight * product;
                }
            }
        }
    }
    return out;
}

SecondOrder second_order_test(const Inspection& inspection, const ExactPacking& packing, const DofMap& dofs) {
    const int internal = inspection.internal_mechanisms();
    if (internal == 0) {
        return SecondOrder::no_mechanism;
    }
    bool all_vanish = true;
    for (const auto& stress : inspection.self_stresses) {
        const Inertia counts = inertia(stress_form(packing, dofs, inspection.contacts, stress, inspection.motions));
        if (counts.positive == internal || counts.negative == internal) {
            return SecondOrder::rigid; // definite on the motions modulo rigid ones: this
                                       // self-stress does not vanish on any of these motions
        }
        all_vanish = all_vanish && counts.positive == 0 && counts.negative == 0;
    }
    // A mechanism v extends exactly when every self-stress vanishes on its curvature. With one self-stress an
    // indefinite or degenerate form has such a v; without self-stress, or with all forms zero, every v is one.
    if (all_vanish || inspection.self_stresses.size() == 1) {
        return SecondOrder::flexes;
    }
    // With one mechanism the test ends above: a form that vanishes for every
    // stress was covered, and a form that does not vanish is definite.
    return SecondOrder::undecided;
}

} // namespace isostat::crafted
