#include "snap/untold.hpp"

#include "contact/candidates.hpp"
#include "core/decimal.hpp"
#include "core/dot.hpp"
#include "io/json.hpp"
#include "linear/factorisation.hpp"
#include "rigidity/isostatic.hpp"
#include "snap/backbone.hpp"

#include <isostat/core/result.hpp>
#include <isostat/snap/snap.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>

namespace isostat::compare {

namespace {

/// The disks that carry forces, in their contacts, with their other pairs, and copies of them with other gaps. For
/// clumps the whole state, with free motions held.
class Copies {
  public:
    Copies(const State& state, const std::vector<Contact>& carrying)
        : backbone_(state.packing.bars.empty() ? backbone_of(state, carrying) : state), dofs_(backbone_.packing) {
        const auto structure = IsostaticStructure::prove(backbone_.packing, backbone_.contacts);
        if (!structure.ok()) {
            return;
        }
        factors_.emplace(structure.value());
        forces = solved(backbone_.packing, *factors_);
        std::vector<Contact> listed = backbone_.contacts;
        std::ranges::sort(listed);
        pairs = without(find_candidates(backbone_.packing, candidate_fraction).contacts, listed);
        for (const Contact& pair : pairs) {
            gaps.push_back(gap(backbone_.packing, pair));
        }
        of_gaps.assign(pairs.size(), 0);
        of_forces.assign(forces.size(), 0);
    }
    [[nodiscard]] bool ok() const { return factors_.has_value(); }

    /// Draws another copy and raises the largest changes by its own, for gaps that are off by `rounding`.
    void draw(std::mt19937_64& random, double rounding) {
        // The step is far above the rounding of doubles and so small that changes are linear; the change is scaled.
        const double step = 1e-7 * backbone_.packing.min_radius();
        std::vector<double> moves(backbone_.contacts.size());
        for (double& approach : moves) {
            approach = (random() >> 63U) != 0 ? step : -step;
        }
        factors_->solve_velocities(moves);
        Packing packing = backbone_.packing;
        dofs_.move(packing.q, moves);
        const double scale = rounding / step;
        for (std::size_t l = 0; l < pairs.size(); ++l) {
            const double change = std::abs(gap(packing, pairs[l]) - gaps[l]);
            of_gaps[l] = std::max(of_gaps[l], change * scale + rounding);
        }
        const auto structure = IsostaticStructure::prove(packing, backbone_.contacts);
        if (!structure.ok()) {
            return;
        }
        const std::vector<double> now = solved(packing, Factorisation(structure.value()));
        for (std::size_t l = 0; l < forces.size(); ++l) {
            of_forces[l] = std::max(of_forces[l], std::abs(now[l] - forces[l]) * scale);
        }
    }

    std::vector<Contact> pairs;
    std::vector<double> gaps, forces, of_gaps, of_forces;

  private:
    [[nodiscard]] std::vector<double> solved(const Packing& packing, const Factorisation& factors) const {
        std::vector<double> out = on_dofs(backbone_.load.external_force(packing), dofs_);
        factors.solve_forces(out);
        return out;
    }

    State backbone_;
    DofMap dofs_;
    std::optional<Factorisation> factors_;
};

/// Adds the rattlers that would be held if the pairs with gaps as small as the possible change were contacts.
void add_rattlers(const State& state, const std::vector<int>& disks, double change, Untold& out) {
    std::vector<Contact> listed = state.contacts;
    std::ranges::sort(listed);
    const auto carries = [&](int i) { return std::ranges::binary_search(disks, i); };
    std::vector<Contact> near;
    for (const Contact& c : without(find_candidates(state.packing, candidate_fraction).contacts, listed)) {
        const bool rattler = !carries(c.i) || (c.of_disks() && !carries(c.j));
        if (rattler && std::abs(gap(state.packing, c)) <= 2 * change) {
            near.push_back(c);
        }
    }
    listed.insert(listed.end(), near.begin(), near.end());
    std::ranges::sort(listed);
    const std::vector<Contact> held = able_to_carry(state.packing, listed);
    for (const Contact& c : near) {
        if (std::ranges::binary_search(held, c)) {
            out.gaps.push_back(c);
            out.rattlers = true;
        }
    }
}

} // namespace

double imported_rounding(const State& state) {
    if (state.provenance.empty()) {
        return 0;
    }
    const auto provenance = json::Json::parse(state.provenance);
    if (!provenance.is_object() || !provenance.contains("rounding")) {
        return 0;
    }
    const auto& value = provenance["rounding"];
    const double rounding = value.is_number() ? value.get<double>() : -1;
    if (!(rounding >= 0 && std::isfinite(rounding))) {
        refuse(ErrorKind::bad_input, "provenance.rounding is {}: expected a length, 0 or more", value.dump());
    }
    return rounding;
}

std::string words_of_copy(const State& state) {
    const auto provenance = state.provenance.empty() ? json::Json() : json::Json::parse(state.provenance);
    const auto jitter = provenance.is_object() ? provenance.find("jitter") : provenance.end();
    if (!provenance.is_object() || jitter == provenance.end() || !jitter->is_number() || jitter->get<double>() == 0) {
        return "";
    }
    return fmt::format("of {} with radii off by up to {:.3g} of each: verdicts, h and jamming are of the copy{}",
                       provenance.value("imported_from", json::Json("a file")).dump(), jitter->get<double>(),
                       provenance.value("jitter_matters", json::Json(false)) == json::Json(true)
                           ? ", and may be others of the file"
                           : "");
}

Untold untold_by(double rounding, const State& state, const Certification& truth) {
    Untold out;
    out.rounding = rounding;
    out.dimension = state.packing.dimension;
    if (rounding == 0 || !truth.claims.vertex || truth.finite.empty()) {
        return out;
    }
    const bool clumps = !state.packing.bars.empty();
    const std::vector<Contact> carrying = clumps ? state.contacts : compare::carrying(state, truth);
    std::vector<int> disks(clumps ? state.packing.radius.size() : 0);
    std::iota(disks.begin(), disks.end(), 0); // for other packings the disks that carry a force
    for (std::size_t l = 0; l < carrying.size() && !clumps; ++l) {
        disks.push_back(carrying[l].i);
        disks.push_back(carrying[l].of_disks() ? carrying[l].j : carrying[l].i);
    }
    std::ranges::sort(disks);
    disks.erase(std::unique(disks.begin(), disks.end()), disks.end());
    Copies copies(state, carrying);
    std::mt19937_64 random(1);
    for (int k = 0; copies.ok() && k < 16; ++k) {
        copies.draw(random, rounding);
    }
    const auto bears = [&](std::size_t l) { // for clumps `carrying` has all rows
        return !clumps || (carrying[l].is_unilateral() && truth.structural_zero[l] == 0);
    };
    const auto sort_out = [&out](double value, double change, const Contact& name, std::vector<Contact>& open) {
        out.refuted = out.refuted || value < -2 * change;
        if (std::abs(value) <= 2 * change) {
            open.push_back(name);
        }
    };
    for (std::size_t l = 0; l < copies.pairs.size(); ++l) {
        sort_out(copies.gaps[l], copies.of_gaps[l], renumbered(copies.pairs[l], disks), out.gaps);
    }
    if (!clumps) {
        add_rattlers(state, disks, std::max(rounding, largest(copies.of_gaps)), out);
    }
    for (std::size_t l = 0; l < copies.forces.size(); ++l) {
        if (bears(l)) {
            ++out.contacts;
            sort_out(copies.forces[l], copies.of_forces[l], carrying[l], out.forces);
        }
    }
    return out;
}

std::string Untold::words() const {
    const auto count = [](std::size_t n, const char* what) {
        return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
    };
    std::string text = gaps.empty() ? "" : count(gaps.size(), "gap") + " (" + names_of(gaps, dimension).substr(1) + ")";
    text += forces.empty() ? ""
                           : fmt::format("{}{} ({})", text.empty() ? "" : " and ", count(forces.size(), "force"),
                                         names_of(forces, dimension).substr(1));
    text += fmt::format(" cannot be told from 0: gaps of the file are known to {}", rounded_up(rounding, 2));
    return gaps.empty() ? text
           : rattlers   ? text + "; some are of rattlers, which may be held"
                        : text + fmt::format("; with these gaps closed N = {} and h = {} (plateau shows that list)",
                                             contacts + static_cast<int>(gaps.size()), gaps.size());
}

Verdict withheld(const Untold& untold, Verdict of_the_doubles) {
    return untold.any() && !(of_the_doubles == Verdict::refuted && untold.refuted) ? Verdict::undecided
                                                                                   : of_the_doubles;
}

void withhold(const Untold& untold, Inspection& inspection) {
    EquilibriumRecord& r = inspection.record;
    const Verdict verdict = withheld(untold, r.verdict);
    if (verdict != r.verdict) {
        inspection.remark = fmt::format("{}{}{}; {} of the stored doubles", untold.words(),
                                        inspection.remark.empty() ? "" : "; ", inspection.remark, to_string(r.verdict));
        r.verdict = inspection.stable = verdict;
    }
}

void withhold(const Untold& untold, JammingAnswer& answer) {
    if (untold.any() && answer.verdict != Verdict::undecided) {
        answer.reason = fmt::format("gaps or forces cannot be told from 0; {} of the stored doubles: {}",
                                    to_string(answer.verdict), answer.reason);
        answer.verdict = Verdict::undecided;
    }
}

void withhold(const Untold& untold, CellInspection& cell) {
    for (JammingAnswer* answer : {&cell.local, &cell.collective, &cell.strict}) {
        withhold(untold, *answer);
    }
}

} // namespace isostat::compare
