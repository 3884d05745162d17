#pragma once
/// \file
/// A vertex with everything that is known about it, and what passes from vertex to vertex: private to the room.

#include "contact/candidates.hpp"
#include "linear/approximate_inverse.hpp"
#include "rigidity/isostatic.hpp"
#include "statics/decisions.hpp"
#include "statics/perturbed.hpp"
#include "verified/configuration.hpp"
#include "verified/proved_structure.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace isostat {

/// Flags of a sorted list of candidates, kept up to date from vertex to vertex: successive structures differ by a few
/// contacts, and the list is the same for many of them.
class KeptCandidates {
  public:
    /// One flag per candidate: 1 when the candidate is in `contacts`. Cost: two comparisons of lists, and a search per
    /// contact whose position changed since the last call. \pre `candidates` sorted. Valid until the next call.
    const std::vector<unsigned char>& of(const std::vector<Contact>& candidates, const std::vector<Contact>& contacts);

  private:
    void set(const Contact& contact, unsigned char flag);

    std::vector<Contact> candidates_;
    std::vector<Contact> contacts_;
    std::vector<unsigned char> kept_;
};

/// Pairs whose gaps are 0, each with the evidence for 0.
using ZeroGaps = std::vector<std::pair<Contact, Order>>;

/// The first-order side of a vertex whose radii are R_i + eps rho_i.
struct FirstOrderVertex {
    /// `rate`: first-order term of the stress. `choose`: what first-order terms leave open is chosen (C1).
    FirstOrderVertex(FirstOrder terms, Statics& forces, const Load& load, const Enclosure& rate, bool choose)
        : first(std::move(terms)), statics(first, forces, load, rate, choose), stress_rate(rate) {}
    FirstOrder first;
    const std::vector<double>* rho = nullptr; ///< direction of the radii
    PerturbedStatics statics;                 ///< refers to `first`
    Enclosure stress_rate;
    /// Pairs that touch in the base without being contacts, with their first-order gaps, proved positive; where ties
    /// are chosen, only not proved negative.
    std::vector<std::pair<Contact, Enclosure>> touching;
    /// The same pairs with the evidence that they touch; pairs that do not move relative to each other have one entry.
    ZeroGaps zero;
    std::vector<ContactId> zeros; ///< of an equilibrium: forces that vanish in the base, see `OpeningDecision`
};

/// The vertex at the end of an arc, whose list differs in one contact from that of the vertex at the start. Everything
/// except the configuration and the two contacts is a guess, which may be absent.
struct Exchange {
    Packing end;
    ContactId leaves; ///< its place is taken by `enters`
    Contact enters;
    std::optional<ExchangedContacts> contacts{};     ///< the list with its matrix; absent: structurally singular
    std::optional<ApproximateInverse> approximate{}; ///< of this matrix; present where `contacts` are
    std::vector<double> forces{};                    ///< finite forces; empty: not known
    std::vector<double> tangent{};                   ///< of the arc at its end, on coordinates; empty: not known
    double cost_before = 0;                          ///< see `Vertex`
};

/// A proved structure with the true vertex near it and its statics. Not movable: the parts refer to each other.
class Vertex : public ProvedStructure {
  public:
    /// Proves the rank, factorises, bounds the inverse, solves the statics and encloses the true vertex.
    /// Failures: `not_isostatic`; `undecided` when no bound of the inverse or no true vertex
    /// near the stored one was proved.
    static Result<std::unique_ptr<Vertex>> make(Packing packing, std::vector<Contact> contacts, const Load& load,
                                                InverseBoundCache& cache, LadderOptions options = {});
    /// `make` in two steps: the unproved data that a motion from the vertex needs, then the proofs.
    struct Beginning {
        Packing packing;
        RankProof rank;
        Factorisation factorisation;
    };
    static Result<Beginning> begin(Packing packing, std::vector<Contact> contacts);
    static Result<std::unique_ptr<Vertex>> make(Beginning beginning, const Load& load, InverseBoundCache& cache,
                                                LadderOptions options = {});
    /// The vertex with one contact of `from` exchanged. The regularity of the new structure and the bound of its
    /// inverse are proved together, by the cheapest of: the bound of `from` carried over (V8), a Cholesky factorisation
    /// (V1), everything anew as in `make`.
    static Result<std::unique_ptr<Vertex>> exchanged(const Vertex& from, Exchange to, const Load& load,
                                                     InverseBoundCache& cache, LadderOptions options);

    VertexEnclosure enclosure;
    Statics statics;
    LadderOptions ladder;   ///< precisions for signs that must climb
    double cost_before = 0; ///< cost of the earlier vertices since the factorisation, in passes of fresh factors

    /// Signs of the gaps of all candidates at the true vertex.
    struct Gaps {
        double margin = 0;
        Rung rung = Rung::double_bound;
        std::optional<Contact> negative; ///< a pair proved to overlap, so it closed earlier
        ZeroGaps zero;                   ///< ties, only when they were asked for
    };
    /// Signs of the gaps of all pairs that are not contacts, at the true vertex:
    /// `candidates` is made anew when it is not complete there (T6). Climbs to double-double
    /// when needed. Failure: `tie`, naming the candidates whose gaps are 0 to the precision
    /// reached. With `known` these candidates are returned instead, or `undecided` when too
    /// few bits say that a gap is 0; pairs in `known` are taken to touch without a
    /// computation. `kept`: flags that serve the next vertices with the same list.
    Result<Gaps> check_gaps(CandidateList& candidates, KeptCandidates& kept, const ZeroGaps* known = nullptr);

    /// Filled under `ties = "choose"` only.
    std::unique_ptr<FirstOrderVertex> perturbed;
    [[nodiscard]] PerturbedStatics* first_order() { return perturbed ? &perturbed->statics : nullptr; }

  private:
    /// Of a structure whose rank is being proved, the vertex counts as proved only after `RankProof` is concluded.
    Vertex(Packing p, IsostaticStructure s, Factorisation factors, const InverseBound& bound, const Load& load,
           StaticsHints hints);
    static Result<std::unique_ptr<Vertex>> prove(const Vertex& from, Exchange& to, const Load& load,
                                                 InverseBoundCache& cache, LadderOptions options);
    /// Puts into `gaps` the signs that double-double left open,
    /// computed with as many bits as the ladder has. Failure: the tie.
    std::optional<Failure> settle_gaps(const std::vector<Contact>& doubtful, const ZeroGaps* known, Gaps& gaps) const;
    /// The first proof that every vertex needs and this one lacks; nothing: it lacks no proof.
    std::optional<Failure> lacking();
};

} // namespace isostat
