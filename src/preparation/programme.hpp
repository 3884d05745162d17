#pragma once
/// \file
/// One linear programme of the sequence: linearised gaps around a configuration, solved by Clp from the previous basis,
/// or by an interior-point method where many pivots are expected.

#include "preparation/interior_point.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/packing/packing.hpp>

#include <atomic>
#include <functional>
#include <vector>

class ClpSimplex;

namespace isostat::preparation {

/// The method that solves the programmes.
enum class ProgrammeMethod : unsigned char {
    simplex,
    interior_first, ///< interior points where many pivots are expected
    interior        ///< interior points, unless they fail: the largest packings, after Newton steps
};

/// The result of one linear programme.
struct ProgrammeStep {
    enum class Outcome { optimal, infeasible, interrupted, failed } outcome = Outcome::failed;
    int status = 0;                   ///< Clp's own, for messages
    long pivots = 0;                  ///< pivots of the simplex method
    long changes = 0;                 ///< pivots, or contacts that the interior-point method dropped or added
    std::vector<double> displacement; ///< one per coordinate of q
    std::vector<Contact> contacts;    ///< rows that are nonbasic: reduced gap 0, sorted
    std::vector<int> at_bounds;       ///< these coordinates, of the simplex method
    int bounds = 0; ///< coordinates that are nonbasic: held by a trust bound; 0: a vertex of the gaps alone. After the
                    ///< interior-point method also the number of missing (or surplus) contacts of a basis
    long iterations = 0; ///< factorisations of a descent
    double largest = 0;  ///< largest |displacement| of a disk's coordinate
};

/// The sequence of programmes; keeps the basis, row by contact, from each programme to the next.
///
/// Scales: lengths of order the radii (mean radius in [0.5, 1)), stress 1, so that contact forces are of order 1. The
/// objective is multiplied by 256, which puts Clp's dual tolerance 1e-9 at 4e-12 of a force and well below the
/// multipliers eps g of rattlers.
class ContactProgramme {
  public:
    /// `infinitesimal`: d n loads g. `trust`: largest displacement of a disk along an axis in one step. `ratio`: stress
    /// on the last axis over the stress on the others.
    ContactProgramme(const std::vector<double>& infinitesimal, double trust, ProgrammeMethod method,
                     const std::atomic<bool>* stop, double ratio = 1);

    /// Minimises sum_a F_a dL_a - eps g.dx, F_a = product of the other lengths (times `ratio` on the last axis), over
    /// displacements within the trust bounds.
    ///
    /// First call: pairs that overlap are taken as contacts with gap 0 (their overlap stays, the next call removes it)
    /// and as the starting basis: from a relaxed soft packing this basis is wrong in a few places only, and the primal
    /// simplex mends it while it keeps the point 0, which is feasible. (Dual simplex from the same basis needs 40 times
    /// more pivots: a few wrong rows put the basic solution far away.) When too few pairs overlap: dual simplex from
    /// the slack basis. Later calls: dual simplex from the basis of the call before; candidates new to the list start
    /// as slacks.
    ProgrammeStep solve(const Packing& packing, double eps);

    /// Runs an interior-point method for the true problem, before the first programme of large packings, with gaps
    /// linearised anew at every step. A sequence of programmes takes programmes times iterations or pivots, because
    /// each vertex moves the relaxing contacts only a little; here the contacts move continuously while the products
    /// slack x force fall. Moves `packing`. Outcome `optimal`: `contacts` may be tried (when `bounds` is 0 they are as
    /// many as columns, and have stayed the same) and are the basis of the next programme. `failed`: `packing` is the
    /// last configuration, and the programmes continue from it. Nothing is proved. `watch` is called after every step.
    /// Cost: 30 to 190 factorisations for 10 000 disks, 260 to 290 for 20 000, 385 for 100 000; no bound is known.
    ProgrammeStep descend(Packing& packing, double eps, const std::function<void(const ProgrammeStep&)>& watch);

    /// Adds missing contacts. The interior-point methods end in the middle of the optimal face where the cost hardly
    /// changes along it, as with a rattler whose load is nearly balanced by one contact; then `contacts` are fewer than
    /// the coordinates. Follows a mechanism of the contacts downhill to the first pair of the last programme that
    /// closes, adds this pair, and repeats: `packing` moves a little. False, with both at the last state, when nothing
    /// closes or too many are missing. Nothing is proved. Cost: a factorisation per contact.
    bool complete(Packing& packing, double eps, std::vector<Contact>& contacts) const;

    /// The pairs that a programme at `packing` holds apart and the bars, whose lengths it keeps, sorted.
    [[nodiscard]] std::vector<Contact> candidates(const Packing& packing) const;

  private:
    struct Rows;
    void collect(const Packing& packing, Rows& rows) const;
    [[nodiscard]] BoxedProgramme boxed(const Packing& packing, const Rows& rows, double eps) const;
    [[nodiscard]] InteriorPoint first_point(const Packing& packing, const Rows& rows) const;
    [[nodiscard]] bool stopped() const;
    /// Sets the start of the simplex method after a descent, and the contacts of the step.
    void keep_basis(Rows rows, const ActiveSet& active, ProgrammeStep& step);
    bool solve_inside(Rows& rows, const BoxedProgramme& programme, ProgrammeStep& step);
    void solve_simplex(const Packing& packing, Rows& rows, const BoxedProgramme& programme, ProgrammeStep& step);
    static void load(ClpSimplex& simplex, const Rows& rows, const BoxedProgramme& programme);
    static bool start_from_overlaps(ClpSimplex& simplex, const Packing& packing, const Rows& rows);
    void start_from_last(ClpSimplex& simplex, const Rows& rows) const;
    void take_solution(const ClpSimplex& simplex, Rows& rows, ProgrammeStep& step);

    const std::vector<double>* infinitesimal_;
    double trust_;
    double ratio_;
    const std::atomic<bool>* stop_;
    ProgrammeMethod method_;
    bool first_ = true;
    bool inside_ = false;              ///< an interior-point method solves the next programme
    std::vector<Contact> row_contact_; ///< sorted
    std::vector<int> row_status_;      ///< Clp's, one per row of the last programme
    std::vector<int> column_status_;
};

} // namespace isostat::preparation
