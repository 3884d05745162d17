#pragma once
/// \file
/// What a run reports, one record per arc and one per equilibrium, and the interface that receives the records.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/motion/arc_certificate.hpp>
#include <isostat/statics/rules.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isostat {

/// How an arc begins: the first arc of a rearrangement, at the limit load; a contact with a negative force opens; one
/// with a negative force under the infinitesimal loads alone (only rattlers move); a held coordinate is released.
enum class ArcKind { limit, tension, rattler, release };
inline constexpr auto arc_kind_words = words_of<ArcKind>("limit", "tension", "rattler", "release");
constexpr std::string_view to_string(ArcKind kind) {
    return word_of(kind, arc_kind_words);
}

/// One arc: a contact opens, the grains follow the mechanism until a contact closes or the power of the load vanishes.
struct ArcRecord {
    long step = 0;       ///< number of the arc in the run, from 1
    int equilibrium = 0; ///< number of the equilibrium that its rearrangement leads to, if it leads to one
    int arc = 0;         ///< number within the rearrangement, from 1
    ArcKind kind = ArcKind::limit;
    Contact opened;          ///< contact that opened, or held coordinate that was released
    Contact closed;          ///< contact that closed, or the coordinate held at a power turn
    double held_at = 0;      ///< power turns: the value of the coordinate held
    bool power_turn = false; ///< true: the arc ended where the power of the load vanished
    double stress = 0;       ///< sigma_2
    double strain = 0;       ///< eps_2 at the end of the arc
    double force = 0;        ///< force in the opened contact: 0 at a limit; infinitesimal force for arcs of rattlers
    double power = 0; ///< -dW/dh at the end, h the gap that closes: the force of the new contact; 0 at a power turn
    double work = 0;  ///< work of the finite loads along the arc: the decrease of W
    /// Proved bounds of the errors of these values; NaN: no bound (the power at a turn, work of true stresses).
    double strain_bound = std::numeric_limits<double>::quiet_NaN();
    double force_bound = std::numeric_limits<double>::quiet_NaN();
    double power_bound = std::numeric_limits<double>::quiet_NaN();
    double work_bound = std::numeric_limits<double>::quiet_NaN();
    double displacement = 0;      ///< largest displacement of a coordinate
    int steps = 0;                ///< predictor steps
    double margin = 0;            ///< smallest |quantity| / bound over the decisions of this arc (> 1: decided); or NaN
    Rung decided_by = Rung::none; ///< highest rung that was needed
    std::optional<ArcCertificate> certificate; ///< at level `arcs` only
    std::vector<TieDecision> perturbed; ///< ties from opening to end that first-order terms settled or the rule chose
};

/// One equilibrium, checked.
struct EquilibriumRecord {
    int number = 0;        ///< 0 = the start
    int segment = 0;       ///< segment of the programme
    double stress = 0;     ///< sigma_2 at which it was reached
    double stress_low = 0; ///< supported interval of sigma_2: [stress_low, stress_high]
    double stress_high = 0;
    double stress_low_bound = 0; ///< bound of the error of `stress_low`; 0 where the interval is unbounded
    double stress_high_bound = 0;
    Contact opens_low; ///< contact whose force vanishes at stress_low (i = -1: the interval is unbounded)
    Contact opens_high;
    double sigma1 = 0;
    double mean_stress = 0, deviator = 0; ///< p and q as in `Load`
    /// The following three are of the true vertex, with bounds of the errors, rounding included.
    std::vector<double> strain; ///< (L_a^0 - L_a) / L_a^0, one per axis: positive in compression
    std::vector<double> strain_bound;
    std::vector<double> length; ///< L_a
    std::vector<double> length_bound;
    double potential = 0; ///< W
    double potential_bound = 0;
    int arcs = 0;           ///< arcs of the rearrangement that led here
    int dof_count = 0;      ///< N_f
    int contact_count = 0;  ///< N
    int rank = 0;           ///< proved rank of H
    int hyperstaticity = 0; ///< h = N - rank
    int mechanisms = 0;     ///< k = N_f - rank
    int rattlers = 0;
    int backbone = 0; ///< contacts whose force is not a structural zero
    int held = 0;     ///< held coordinates (0 in an ordinary equilibrium)
    /// Where ties are settled at first order: pairs that touch without being contacts. Each adds a self-stress.
    std::optional<int> touching;
    double min_force = 0; ///< smallest backbone force
    Contact min_force_contact;
    /// Smallest gap at the true vertex of all pairs that are not contacts and can move relative to each other;
    /// infinity, with i = -1 for the contact, when there is no such pair.
    double min_gap = 0;
    double min_gap_bound = 0;
    Contact min_gap_contact;
    double force_bound = 0;     ///< proved bound on the error of every force as recorded
    double sigma_min_bound = 0; ///< proved lower bound of the smallest singular value of H
    double balance = 0;         ///< max |H f - F_ext| (double-double residual)
    double virtual_power = 0;   ///< |f.(G v) - F.v| for a recorded random v, relative
    double gap_residual = 0;    ///< max |gap| over the contacts
    double margin = 0;          ///< smallest |quantity| / bound over the decisions since the previous equilibrium
    Rung decided_by = Rung::none;
    Verdict verdict = Verdict::undecided; ///< proved: every check of this record holds for the stored configuration
    std::optional<Verdict> certified;     ///< verdict of its certificate file, from level `states` on
    double seconds = 0;                   ///< since the start of the run
};

/// What a decision was about.
enum class DecisionKind : unsigned char {
    gaps,       ///< whether candidates overlap at the end of an arc: which gap closed first
    power,      ///< whether the power of the load is positive where an arc ends
    opening,    ///< which contact opens: an arc was started with this contact
    equilibrium ///< whether every force is positive, both ends of the supported interval, what opens there
};
inline constexpr auto decision_kind_words = words_of<DecisionKind>("gaps", "power", "opening", "equilibrium");
inline constexpr int decision_kinds = decision_kind_words.size();
constexpr std::string_view to_string(DecisionKind kind) {
    return word_of(kind, decision_kind_words);
}

/// How much of a run is proved.
/// - decisions: the equilibria (rank, signs of all forces, both ends of the supported interval, no overlap) and every
///   comparison that the path depends on, with a bound of the error on both sides;
/// - states: in addition a certificate file for each equilibrium (an observer writes these files);
/// - arcs: in addition each arc is enclosed between its events (`certify_arc`). An arc that is not certified does not
///   stop the run: it is counted and its record says why.
enum class CertifyLevel : unsigned char { decisions, states, arcs };
inline constexpr auto certify_level_words = words_of<CertifyLevel>("decisions", "states", "arcs");
constexpr const char* to_string(CertifyLevel level) {
    return word_of(level, certify_level_words);
}

/// Equilibria counted by the verdict of their certificates (from level `states` on).
struct StateTally {
    long proved = 0;
    long refuted = 0;
    long undecided = 0;
    double seconds = 0; ///< time of the certificates
};

/// Arcs counted by the verdict of their certificates (level `arcs`).
struct ArcTally {
    long certified = 0;
    long undecided = 0;
    long power_undecided = 0; ///< among the certified ones
    long pieces = 0;
    long factorisations = 0; ///< fresh centres: one rank proof, factorisation and bound of the inverse each
    double tube_margin = 0;  ///< smallest over all certified arcs (0: none yet)
    double gap_margin = 0;
    double seconds = 0; ///< time of the certificates
};

/// Decisions counted by the rung that settled them.
struct Tally {
    long combinatorial = 0;
    long double_bound = 0;
    long double_double = 0;
    long multiprecision = 0;
    long exact = 0;
    long undecided = 0; ///< segments ended by a sign or an order that no rung settled
    long ties = 0;      ///< of `undecided`: quantities equal exactly or to the last bit tried
    long structural_ties =
        0; ///< forces that vanish together for a structural reason, ordered by the infinitesimal loads
    /// Decisions that a first-order comparison settled, by kind (included in the counts above).
    std::array<long, decision_kinds> perturbed{};
    long choices = 0;           ///< ties in records of arcs that first-order terms left open and the rule chose
    double smallest_margin = 0; ///< smallest |quantity| / bound over the decided ones (0: none yet)
    /// decisions of each kind on the rungs combinatorial, double, double-double, mpfr, exact
    std::array<std::array<long, 5>, decision_kinds> by_kind{};
    std::array<double, decision_kinds> smallest_margin_of{}; ///< 0: none yet

    /// Adds one decision.
    void count(DecisionKind kind, double margin, Rung rung);
};

struct Segment;
class ProvedStructure;

/// Receives the records of a run as they are made. Each call returns before the run goes on, so a killed run has
/// written everything that it had found. After each equilibrium the run asks for an objection, which ends the run.
class RunObserver {

  public:
    virtual ~RunObserver() = default;
    /// Called before a segment of a programme (`play`): number and goal of the segment, equilibria already made in it
    /// (after a resume), and the state that it starts from.
    virtual void on_segment(int /*number*/, const Segment& /*goal*/, int /*made*/, const State& /*from*/) {}
    virtual void on_arc(const ArcRecord& /*arc*/) {}
    /// Before each equilibrium: what is proved of its structure, until `on_equilibrium` returns.
    virtual void on_structure(const ProvedStructure& /*proved*/) {}
    virtual void on_equilibrium(const EquilibriumRecord& /*record*/, const State& /*state*/,
                                const std::vector<double>& /*forces, one per contact of the state*/) {}
    /// Why the run must not go on after the equilibrium that it has just passed on; nothing: it goes on.
    [[nodiscard]] virtual std::optional<Failure> objection() const { return std::nullopt; }
};

} // namespace isostat
