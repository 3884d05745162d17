#include "support/shortcuts/small_displacements.hpp"

#include "contact/contact_set.hpp"
#include "contact/words.hpp"
#include "core/dot.hpp"
#include "statics/decisions.hpp"

#include <isostat/core/machine.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

namespace isostat {

namespace {

constexpr double frozen_excess = 1e-10;

class ProcessorTime {
  public:
    explicit ProcessorTime(double& sum) : sum_(sum), begin_(std::clock()) {}
    ~ProcessorTime() { sum_ += static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC; }
    ProcessorTime(const ProcessorTime&) = delete;
    ProcessorTime& operator=(const ProcessorTime&) = delete;

  private:
    double& sum_;
    std::clock_t begin_;
};

} // namespace

Result<LinearEvent> find_linear_event(const Packing& packing, const IsostaticStructure& structure,
                                      const Factorisation& factorisation, ContactId opened, int direction,
                                      const std::vector<Contact>& pairs, const std::vector<double>& gaps) {
    std::vector<double> v(static_cast<std::size_t>(structure.size()), 0.0);
    v[opened.index()] = -direction; // approach velocities: the opened gap grows
    factorisation.solve_velocities(v);
    const double fastest = largest(v);
    LinearEvent event;
    event.velocity.assign(packing.q.size(), 0.0);
    for (std::size_t mu = 0; mu < v.size(); ++mu) {
        const int c = structure.dofs().coordinate_of(static_cast<int>(mu));
        event.velocity[static_cast<std::size_t>(c)] = v[mu] / fastest;
    }
    const ContactSet kept(structure.contacts(), packing.disk_count());
    event.length = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (kept.contains(pairs[k])) {
            continue;
        }
        const double falls = -gap_gradient(packing, pairs[k]).rate(event.velocity).value;
        if (falls > 0) {
            // A gap that is negative already (a drifted configuration) closes at once.
            const double s = std::max(0.0, gaps.empty() ? gap(packing, pairs[k]) : gaps[k]) / falls;
            if (s < event.length) {
                event.length = s;
                event.closed = pairs[k];
            }
        }
    }
    if (!std::isfinite(event.length)) {
        return failed(FailureKind::unbounded, "no listed gap falls when {} opens",
                      named(structure.contacts()[opened.index()]));
    }
    for (const double c : event.velocity) {
        event.displacement.push_back(event.length * c);
    }
    return event;
}

namespace {

/// Geometry and gaps of the approximation.
struct Approximation {
    Packing geometry;           ///< where normals are taken
    Packing grains;             ///< where the grains are
    std::vector<Contact> pairs; ///< with the gaps of `linear`
    std::vector<double> linear; ///< empty: those of the geometry
};

std::vector<Contact> pairs_near(const Packing& packing, std::vector<Contact> contacts) {
    std::vector<Contact> pairs = find_candidates(packing, candidate_fraction).contacts;
    pairs.insert(pairs.end(), contacts.begin(), contacts.end());
    std::ranges::sort(pairs);
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

/// Loading with linear gaps, an arc after the other.
class LinearLoading {
  public:
    LinearLoading(const State& start, LinearGeometry geometry)
        : at_{start.packing, start.packing, {}, {}}, contacts_(start.contacts), load_(start.load),
          reference_(start.packing.length(start.load.loaded_axis)), frozen_(geometry == LinearGeometry::frozen) {
        if (!frozen_) {
            return;
        }
        const ContactSet first(contacts_, start.packing.disk_count());
        at_.pairs = pairs_near(start.packing, contacts_);
        for (const Contact& c : at_.pairs) {
            at_.linear.push_back(first.contains(c) ? 0.0 : gap(start.packing, c));
        }
    }

    LinearTrajectory run(int equilibria, long max_arcs) {
        while (run_.stopped.empty() && static_cast<int>(run_.equilibria.size()) <= equilibria) {
            auto structure = IsostaticStructure::prove(at_.geometry, contacts_);
            if (!structure.ok()) {
                run_.stopped = structure.failure().message();
                break;
            }
            std::optional<Factorisation> factorisation;
            {
                const ProcessorTime time(run_.seconds);
                factorisation.emplace(structure.value());
            }
            const std::optional<Opening> opening = open(structure.value(), *factorisation);
            if (!opening || static_cast<int>(run_.equilibria.size()) > equilibria) {
                break;
            }
            if (static_cast<long>(run_.arcs.size()) >= max_arcs) {
                run_.stopped = fmt::format("{} arcs", max_arcs);
                break;
            }
            move(structure.value(), *factorisation, *opening);
        }
        return std::move(run_);
    }

  private:
    /// What opens: a tension; at an equilibrium, which is recorded, the contact whose force vanishes first. Nothing:
    /// the run stops.
    std::optional<Opening> open(const IsostaticStructure& structure, const Factorisation& factorisation) {
        const InverseBound inverse = bound_inverse(structure, factorisation, cache_);
        const ProcessorTime time(run_.seconds);
        Statics statics(at_.geometry, load_, structure, factorisation, inverse);
        const auto decision = decide_opening(statics, stress(), OpeningRule::most_negative, {}, std::uint64_t{0});
        if (!decision.ok()) {
            run_.stopped = decision.failure().message();
            return {};
        }
        return decision.value().opening ? decision.value().opening : open_at_limit(statics);
    }

    std::optional<Opening> open_at_limit(Statics& statics) {
        auto limit = find_limit(statics, stress(), +1);
        run_.equilibria.push_back({stress(), std::numeric_limits<double>::infinity(),
                                   (reference_ - at_.grains.length(load_.loaded_axis)) / reference_, arcs_});
        if (!limit.ok() || limit.value().unbounded) {
            run_.stopped = limit.ok() ? "every load is supported" : limit.failure().message();
            return {};
        }
        run_.equilibria.back().stress_high = limit.value().stress;
        load_.set_loaded_stress(limit.value().stress);
        if (frozen_) {
            // To first order the new contact carries nothing at the limit itself: rounding would decide whether the
            // arc is taken back.
            load_.set_loaded_stress(
                stress() + std::max(4 * limit.value().stress_error, frozen_excess * std::abs(limit.value().stress)));
        }
        arcs_ = 0;
        Opening opening;
        opening.contact = limit.value().opens;
        return opening;
    }

    /// One arc.
    void move(const IsostaticStructure& structure, const Factorisation& factorisation, const Opening& opening) {
        ++arcs_;
        const ProcessorTime time(run_.seconds);
        if (!frozen_) {
            at_.pairs = pairs_near(at_.geometry, {});
        }
        auto event = find_linear_event(at_.geometry, structure, factorisation, opening.contact, opening.direction,
                                       at_.pairs, at_.linear);
        if (!event.ok()) {
            run_.stopped = event.failure().message();
            return;
        }
        for (std::size_t c = 0; c < at_.grains.q.size(); ++c) {
            at_.grains.q[c] += event.value().displacement[c];
        }
        Contact& changes = contacts_[opening.contact.index()];
        LinearArc arc{static_cast<int>(run_.equilibria.size()) - 1, stress(), changes, event.value().closed, 0};
        changes = event.value().closed;
        if (frozen_) {
            for (std::size_t k = 0; k < at_.pairs.size(); ++k) {
                at_.linear[k] += gap_gradient(at_.geometry, at_.pairs[k]).rate(event.value().displacement).value;
            }
        } else {
            snap_to_grid(at_.grains);
            at_.geometry = at_.grains;
        }
        for (const Contact& c : contacts_) {
            arc.drift = std::max(arc.drift, std::abs(gap(at_.grains, c)) / at_.grains.min_radius());
        }
        run_.arcs.push_back(arc);
        run_.coordinates.push_back(at_.grains.q);
    }

    [[nodiscard]] double stress() const { return load_.loaded_stress(); }

    LinearTrajectory run_;
    Approximation at_;
    std::vector<Contact> contacts_;
    Load load_;
    double reference_; ///< length along the loaded axis at the start
    bool frozen_;
    InverseBoundCache cache_;
    int arcs_ = 0; ///< since the last equilibrium
};

} // namespace

LinearTrajectory load_with_linear_gaps(const State& start, LinearGeometry geometry, int equilibria, long max_arcs) {
    require_floating_point();
    return LinearLoading(start, geometry).run(equilibria, max_arcs);
}

} // namespace isostat
