#include "contact/contact_set.hpp"
#include "core/splitmix.hpp"
#include "crafted/inspection_parts.hpp"
#include "rigidity/strained_matrix.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/core/result.hpp>
#include <isostat/crafted/exact_packing.hpp>

#include <algorithm>

namespace isostat::crafted {

namespace {

/// The contact matrix of the same contact graph for random integer coordinates of the disks, and of the periods and
/// tilt of a cell; columns are scaled by the distance.
exact::NumberMatrix generic_matrix(const ExactPacking& packing, const DofMap& dofs,
                                   const std::vector<Contact>& contacts) {
    ExactPacking random = packing;
    std::uint64_t place = 1; // the same points at every call
    const auto next = [&] { return Number(static_cast<long long>(splitmix(0, ++place) >> 3)); }; // 61 bits
    for (std::size_t i = 0; i < random.radius.size(); ++i) {
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            random.centre[i][a] = next();
        }
        random.radius[i] = Number(1) / Number(2);
    }
    for (std::size_t b = 0; b < packing.axes(); ++b) {
        random.length[b] = packing.cell.periodic[b] ? next() : random.length[b];
        for (std::size_t a = 0; a < b; ++a) {
            if (packing.cell.periodic[a] && packing.cell.periodic[b]) {
                random.tilt[Cell::tilt(a, b)] = next();
            }
        }
    }
    return exact_contact_matrix(random, dofs, contacts);
}

/// The counts of all touching pairs, for each way to strain the cell.
StrainCounts exact_strains(const ExactPacking& packing, const std::vector<Contact>& touching) {
    const Packing rounded = approximate(packing);
    StrainCounts counts;
    std::ranges::transform(strains, counts.begin(), [&](Strain strain) {
        return without_bars(count_matrix(strained_matrix(
                                rounded, [&](std::size_t k) { return packing.coordinate(k); }, touching, strain)),
                            bar_count(touching));
    });
    return counts;
}

/// The same packing with a cell whose coordinates all move.
ExactPacking loose_cell(ExactPacking packing) {
    packing.cell.move(true, true);
    return packing;
}

class Inspector {
  public:
    Inspector(const ExactPacking& packing, const InspectionLimits& limits, std::vector<Contact> contacts)
        : packing_(packing), limits_(limits), dofs_(approximate(packing)) {
        out_.contacts = std::move(contacts);
        unilateral_ = static_cast<std::size_t>(out_.contact_count());
        matrix_ = exact_contact_matrix(packing_, dofs_, out_.contacts);
        out_.dof_count = dofs_.dof_count();
        out_.rigid_motions = rigid_motions(
            approximate(packing_), [](int) { return true; }, [&](std::size_t k) { return packing_.coordinate(k); });
        out_.with_radii = count_with_radii(packing_, out_.contacts);
    }

    Inspection run() {
        count();
        judge_holds(out_, packing_);
        judge_self_stresses();
        judge_ranges();
        judge_load();
        if (out_.bases_exact == Verdict::proved) {
            out_.second_order = second_order_test(out_, packing_, dofs_);
        } else if (out_.rank_exact == Verdict::proved && out_.internal_mechanisms() == 0) {
            out_.second_order = SecondOrder::no_mechanism;
        }
        judge_stability();
        const int bars = bar_count(out_.contacts);
        out_.dof_count -= bars;
        out_.rank -= bars;
        out_.generic_rank -= bars;
        out_.with_radii = without_bars(out_.with_radii, bars);
        return std::move(out_);
    }

  private:
    [[nodiscard]] std::size_t contact_count() const { return out_.contacts.size(); } // counts the bars too
    /// The forces without those of bars, whose sign is free.
    [[nodiscard]] std::vector<Number> unilateral(const std::vector<Number>& forces) const {
        return {forces.begin(), forces.begin() + static_cast<std::ptrdiff_t>(unilateral_)};
    }

    [[nodiscard]] std::vector<std::pair<int, Number>> load_column() const {
        std::vector<std::pair<int, Number>> column;
        const std::vector<Number> force = external_force(packing_, dofs_);
        for (std::size_t d = 0; d < force.size(); ++d) {
            if (!force[d].is_zero()) {
                column.emplace_back(static_cast<int>(d), -force[d]);
            }
        }
        return column;
    }

    /// The columns of the contacts, of the load, and of a unit load on each length and tilt that moves.
    [[nodiscard]] exact::NumberMatrix with_loads() const {
        exact::NumberMatrix out = matrix_;
        if (packing_.load) {
            out.column.push_back(load_column());
            for (int d = 0; d < out_.dof_count; ++d) {
                if (static_cast<std::size_t>(dofs_.coordinate_of(d)) >= packing_.layout().of_length(0)) {
                    out.column.push_back({{d, Number(1)}});
                }
            }
        }
        return out;
    }

    /// Sorts the kernel of that matrix into self-stresses, forces that balance the load, and forces of each unit load.
    void take_basis(const exact::Kernel& kernel, const exact::NumberMatrix& augmented) {
        const std::size_t n = contact_count();
        for (std::size_t k = 0; k < kernel.basis.size(); ++k) {
            const auto& vector = kernel.basis[k];
            const auto free = static_cast<std::size_t>(kernel.free[k]);
            std::vector<Number> forces(vector.begin(), vector.begin() + static_cast<std::ptrdiff_t>(n));
            if (free < n) {
                out_.self_stresses.push_back(std::move(forces));
            } else if (free == n) {
                balanced_ = true;
                out_.forces = std::move(forces); // the vector whose free column is the load
            } else if (vector[n].is_zero() && std::all_of(vector.begin() + static_cast<std::ptrdiff_t>(n),
                                                          vector.begin() + static_cast<std::ptrdiff_t>(free),
                                                          [](const Number& x) { return x.is_zero(); })) {
                units_.emplace_back(augmented.column[free].front().first, std::move(forces));
            }
        }
    }

    void count() {
        const exact::NumberMatrix augmented = with_loads();
        const int n = static_cast<int>(contact_count());
        const exact::Kernel stresses = exact::kernel(augmented, limits_.kernel);
        const exact::Kernel motions = exact::kernel(exact::transposed(matrix_), limits_.kernel);
        const bool load_is_pivot = packing_.load && std::ranges::binary_search(stresses.pivots, n);
        const bool dense = stresses.exact == Verdict::proved;
        const auto of_contacts = std::ranges::lower_bound(stresses.pivots, n);
        out_.rank = std::max(dense ? static_cast<int>(of_contacts - stresses.pivots.begin()) : 0, motions.rank);
        const int most = std::min(n, out_.dof_count - out_.rigid_motions);
        const bool exact = dense || motions.exact == Verdict::proved || out_.rank == most;
        out_.rank_exact = exact ? Verdict::proved : Verdict::undecided;
        out_.hyperstaticity = n - out_.rank;
        out_.mechanisms = out_.dof_count - out_.rank;
        if (dense && motions.exact == Verdict::proved) {
            out_.bases_exact = Verdict::proved;
            out_.motions = motions.basis;
            take_basis(stresses, augmented);
            out_.support =
                !packing_.load ? Support::no_load : (load_is_pivot ? Support::unbalanced : Support::undecided);
        } else if (packing_.load) {
            out_.support = Support::undecided;
        }
        out_.generic_rank = exact::rank_bound(generic_matrix(packing_, dofs_, out_.contacts)).rank;
        if (exact) {
            out_.special_position = out_.rank < out_.generic_rank
                                        ? Verdict::proved
                                        : (out_.rank == most ? Verdict::refuted : Verdict::undecided);
        }
    }

    [[nodiscard]] bool affordable(std::size_t rows, std::size_t cols) const {
        return static_cast<long long>((rows + 1) * cols) <= limits_.programme_cells;
    }

    void judge_self_stresses() {
        if (out_.rank_exact == Verdict::proved && out_.hyperstaticity == 0) {
            out_.one_sign_decided = true;
        } else if (out_.bases_exact == Verdict::proved && affordable(out_.self_stresses.size(), contact_count())) {
            out_.one_sign = exact::one_sign(out_.self_stresses, out_.contact_count());
            out_.one_sign_decided = true;
        }
    }

    /// Finds the range of every force on a length or a tilt whose change can be balanced.
    void judge_ranges() {
        if (!balanced_ || !affordable(out_.self_stresses.size() + 2, contact_count())) {
            return;
        }
        const std::vector<Number> load = external_force(packing_, dofs_);
        for (const auto& [dof, change] : units_) {
            if (auto range = load_range(unilateral(out_.forces), change, out_.self_stresses)) {
                range->dof = dof;
                for (std::optional<Number>* end : {&range->least, &range->most}) {
                    if (*end) {
                        **end -= load[static_cast<std::size_t>(dof)];
                    }
                }
                out_.ranges.push_back(std::move(*range));
            }
        }
    }

    void judge_load() {
        if (!balanced_) {
            return;
        }
        out_.forces_unique = out_.self_stresses.empty();
        if (out_.forces_unique) {
            int least = 1;
            for (const Number& f : unilateral(out_.forces)) {
                least = std::min(least, f.sign());
            }
            judge_zeros();
            out_.support = least > 0 ? Support::positive : (least == 0 ? Support::with_zeros : Support::none);
            if (least >= 0) {
                judge_disks();
            }
            return;
        }
        if (!affordable(out_.self_stresses.size() + 1, contact_count() + 1)) {
            return;
        }
        // f = f0 + S c > 0 is t f0 + S c > 0 with t > 0: one more component for t, before the components of bars.
        std::vector<std::vector<Number>> span = out_.self_stresses;
        span.push_back(out_.forces);
        for (auto& vector : span) {
            vector.insert(vector.begin() + static_cast<std::ptrdiff_t>(unilateral_),
                          Number(&vector == &span.back() ? 1 : 0));
        }
        const exact::OneSignAnswer answer = exact::one_sign(span, out_.contact_count() + 1);
        if (answer.kind == exact::OneSign::none) {
            out_.support = Support::none;
        } else if (answer.combination[unilateral_].sign() > 0) {
            take(answer.combination);
            out_.support = answer.kind == exact::OneSign::strict ? Support::positive : Support::with_zeros;
        } else if (packing_.bars.empty() && affordable(static_cast<std::size_t>(out_.dof_count), contact_count())) {
            std::vector<std::vector<Number>> rows(static_cast<std::size_t>(out_.dof_count),
                                                  std::vector<Number>(contact_count()));
            for (std::size_t l = 0; l < contact_count(); ++l) {
                for (const auto& [d, value] : matrix_.column[l]) {
                    rows[static_cast<std::size_t>(d)][l] = value;
                }
            }
            const auto point =
                exact::feasible_point(rows, external_force(packing_, dofs_), static_cast<int>(contact_count()));
            out_.support = point.feasible ? Support::with_zeros : Support::none;
            if (point.feasible) {
                out_.forces = point.solution;
            }
        }
    }

    void judge_disks() {
        std::vector<unsigned char> zero;
        for (const Number& force : out_.forces) {
            zero.push_back(force.is_zero() ? 1 : 0);
        }
        out_.without_force = untouched(packing_.disk_count(), unmarked(out_.contacts, zero));
        std::erase_if(out_.without_force, [this](int i) { return packing_.is_fixed(i); });
    }

    /// A force f_l vanishes for given columns exactly when the load is in the span of the other columns.
    void judge_zeros() {
        exact::NumberMatrix generic = generic_matrix(packing_, dofs_, out_.contacts);
        generic.column.push_back(load_column());
        const int n = static_cast<int>(contact_count());
        if (out_.generic_rank < n || exact::rank_bound(generic).rank > n) {
            return; // generic coordinates do not balance this load, so no zero is structural
        }
        out_.structural_zero.assign(contact_count(), 0);
        for (std::size_t l = 0; l < contact_count(); ++l) {
            if (out_.forces[l].is_zero()) {
                exact::NumberMatrix others = generic;
                others.column.erase(others.column.begin() + static_cast<std::ptrdiff_t>(l));
                out_.structural_zero[l] = exact::rank_bound(others).rank < n ? 1 : 0;
            }
        }
    }

    void take(const std::vector<Number>& combination) {
        const Number scale = combination[unilateral_].inverse();
        for (std::size_t l = 0; l < contact_count(); ++l) {
            out_.forces[l] = combination[l < unilateral_ ? l : l + 1] * scale;
        }
    }

    void judge_stability() {
        if (out_.support == Support::none || out_.support == Support::unbalanced) {
            out_.stable = packing_.bars.empty() || out_.hyperstaticity == 0 ? Verdict::refuted : Verdict::undecided;
            return;
        }
        if (!balanced_ || out_.support == Support::undecided) {
            return;
        }
        const Inertia work = inertia(stress_form(packing_, dofs_, out_.contacts, out_.forces, out_.motions));
        if (work.positive > 0) {
            out_.stable = out_.forces_unique ? Verdict::refuted : Verdict::undecided;
        } else if (out_.support == Support::positive && out_.internal_mechanisms() == 0) {
            out_.stable = Verdict::proved;
        }
    }

    const ExactPacking& packing_;
    const InspectionLimits& limits_;
    DofMap dofs_;
    exact::NumberMatrix matrix_;
    Inspection out_;
    std::size_t unilateral_ = 0;                             // number of contacts that are no bars
    std::vector<std::pair<int, std::vector<Number>>> units_; // forces that balance an inward unit at this dof
    bool balanced_ = false; // some forces balance the load, and `forces` holds them (without contacts it is empty)
};

/// Whether all walls are fixed and no disk is.
bool walls_stay(const ExactPacking& packing) {
    bool stay = !packing.cell.any() && std::ranges::find(packing.fixed, 1) == packing.fixed.end();
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        stay = stay && packing.walls.lower[a] == WallKind::fixed && packing.walls.upper[a] == WallKind::fixed;
    }
    return stay;
}

} // namespace

std::string Inspection::verdict() const {
    if (rank_exact != Verdict::proved) {
        return "undecided";
    }
    const bool over = hyperstaticity > 0, under = internal_mechanisms() > 0;
    return over && under ? "hyperstatic and hypostatic" : (over ? "hyperstatic" : (under ? "hypostatic" : "isostatic"));
}

Result<Inspection> inspect(const ExactPacking& packing, const InspectionLimits& limits) {
    require_floating_point();
    auto contacts = exact_contacts(packing);
    if (!contacts.ok()) {
        return contacts.failure();
    }
    Inspection out = Inspector(packing, limits, std::move(contacts.value())).run();
    if (packing.cell.all()) {
        out.strains = exact_strains(packing, exact_contacts(loose_cell(packing)).value());
    }
    if (packing.bars.empty() && (packing.cell.all() || walls_stay(packing))) {
        out.jamming = judge_jamming(packing, out.hold, limits);
    }
    return out;
}

Result<Inspection> inspect_file(const PackingFile& file, const std::string& source) {
    try {
        return inspect(file.packing);
    } catch (const Error& error) { // of the search for contacts in a cell, which reaches a little farther than touching
        throw Error(error.kind(), source + ": " + error.what());
    }
}

Inspection inspect_contacts(const ExactPacking& packing, const std::vector<Contact>& contacts,
                            const InspectionLimits& limits) {
    require_floating_point();
    Inspection out = Inspector(packing, limits, contacts).run();
    if (packing.cell.all()) {
        out.strains = exact_strains(packing, contacts);
    }
    return out;
}

} // namespace isostat::crafted
