#include "shortcuts/small_displacements.hpp"

#include "contact/contact_set.hpp"
#include "contact/words.hpp"
#include "statics/decisions.hpp"

#include <isostat/core/floating_point.hpp>

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

template <int Dim> double rate(const GapGradient<Dim>& gradient, const std::vector<double>& v) {
    double sum = 0;
    for (int e = 0; e < gradient.count; ++e) {
        const auto k = static_cast<std::size_t>(e);
        sum += gradient.value[k] * v[static_cast<std::size_t>(gradient.coordinate[k])];
    }
    return sum;
}

} // namespace

template <int Dim>
Result<LinearEvent> find_linear_event(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                                      const Factorisation& factorisation, ContactId opened, int direction,
                                      const std::vector<Contact>& pairs, const std::vector<double>& gaps) {
    std::vector<double> v(static_cast<std::size_t>(structure.size()), 0.0);
    v[opened.index()] = -direction; // approach velocities: the opened gap grows
    factorisation.solve_velocities(v);
    double fastest = 0;
    for (const double c : v) {
        fastest = std::max(fastest, std::abs(c));
    }
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
        const double falls = -rate(gap_gradient(packing, pairs[k]), event.velocity);
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
                      named<Dim>(structure.contacts()[opened.index()]));
    }
    for (const double c : event.velocity) {
        event.displacement.push_back(event.length * c);
    }
    return event;
}

namespace {

/// Geometry and gaps of the approximation.
template <int Dim> struct Approximation {
    Packing<Dim> geometry;      ///< where normals are taken
    Packing<Dim> grains;        ///< where the grains are
    std::vector<Contact> pairs; ///< with the gaps of `linear`
    std::vector<double> linear; ///< empty: those of the geometry
};

template <int Dim> std::vector<Contact> pairs_near(const Packing<Dim>& packing, std::vector<Contact> contacts) {
    std::vector<Contact> pairs = find_candidates(packing, candidate_fraction).contacts;
    pairs.insert(pairs.end(), contacts.begin(), contacts.end());
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

} // namespace

template <int Dim>
LinearTrajectory<Dim> load_with_linear_gaps(const State<Dim>& start, LinearGeometry geometry, int equilibria,
                                            long max_arcs) {
    require_floating_point();
    LinearTrajectory<Dim> run;
    Approximation<Dim> at{start.packing, start.packing, {}, {}};
    std::vector<Contact> contacts = start.contacts;
    Load<Dim> load = start.load;
    const auto axis = static_cast<std::size_t>(load.loaded_axis);
    const bool frozen = geometry == LinearGeometry::frozen;
    if (frozen) {
        const ContactSet first(contacts, start.packing.disk_count());
        at.pairs = pairs_near(start.packing, contacts);
        for (const Contact& c : at.pairs) {
            at.linear.push_back(first.contains(c) ? 0.0 : gap(start.packing, c));
        }
    }
    InverseBoundCache cache;
    int arcs = 0;
    std::optional<Opening> opening;
    while (true) {
        auto structure = IsostaticStructure<Dim>::prove(at.geometry, contacts);
        if (!structure.ok()) {
            run.stopped = structure.failure().message();
            return run;
        }
        std::optional<Factorisation> factorisation;
        {
            const ProcessorTime time(run.seconds);
            factorisation.emplace(structure.value());
        }
        const InverseBound inverse = bound_inverse(structure.value(), *factorisation, cache);
        std::optional<Statics<Dim>> statics;
        {
            const ProcessorTime time(run.seconds);
            statics.emplace(at.geometry, load, structure.value(), *factorisation, inverse);
            auto decision =
                decide_opening(*statics, load.stress[axis], OpeningRule::most_negative, ContactId(), std::uint64_t{0});
            if (!decision.ok()) {
                run.stopped = decision.failure().message();
                return run;
            }
            opening = decision.value().opening;
            if (!opening) {
                auto limit = find_limit(*statics, load.stress[axis], +1);
                const double reference = start.packing.length(load.loaded_axis);
                run.equilibria.push_back({load.stress[axis], std::numeric_limits<double>::infinity(),
                                          (reference - at.grains.length(load.loaded_axis)) / reference, arcs});
                if (!limit.ok() || limit.value().unbounded) {
                    run.stopped = limit.ok() ? "every load is supported" : limit.failure().message();
                    return run;
                }
                run.equilibria.back().stress_high = limit.value().stress;
                if (static_cast<int>(run.equilibria.size()) > equilibria) {
                    return run;
                }
                load.stress[axis] = limit.value().stress;
                if (frozen) {
                    // To first order the new contact carries nothing at the limit itself: rounding would decide
                    // whether the arc is taken back.
                    load.stress[axis] +=
                        std::max(4 * limit.value().stress_error, frozen_excess * std::abs(limit.value().stress));
                }
                opening = Opening{};
                opening->contact = limit.value().opens;
                arcs = 0;
            }
        }
        if (static_cast<long>(run.arcs.size()) >= max_arcs) {
            run.stopped = fmt::format("{} arcs", max_arcs);
            return run;
        }
        ++arcs;
        const ProcessorTime time(run.seconds);
        if (!frozen) {
            at.pairs = pairs_near(at.geometry, {});
        }
        auto event = find_linear_event(at.geometry, structure.value(), *factorisation, opening->contact,
                                       opening->direction, at.pairs, at.linear);
        if (!event.ok()) {
            run.stopped = event.failure().message();
            return run;
        }
        for (std::size_t c = 0; c < at.grains.q.size(); ++c) {
            at.grains.q[c] += event.value().displacement[c];
        }
        LinearArc arc{static_cast<int>(run.equilibria.size()) - 1, load.stress[axis],
                      contacts[opening->contact.index()], event.value().closed, 0};
        contacts[opening->contact.index()] = event.value().closed;
        if (frozen) {
            for (std::size_t k = 0; k < at.pairs.size(); ++k) {
                at.linear[k] += rate(gap_gradient(at.geometry, at.pairs[k]), event.value().displacement);
            }
        } else {
            snap_to_grid(at.grains);
            at.geometry = at.grains;
        }
        for (const Contact& c : contacts) {
            arc.drift = std::max(arc.drift, std::abs(gap(at.grains, c)) / at.grains.min_radius());
        }
        run.arcs.push_back(arc);
        run.coordinates.push_back(at.grains.q);
    }
}

template Result<LinearEvent> find_linear_event<2>(const Packing<2>&, const IsostaticStructure<2>&, const Factorisation&,
                                                  ContactId, int, const std::vector<Contact>&,
                                                  const std::vector<double>&);
template LinearTrajectory<2> load_with_linear_gaps<2>(const State<2>&, LinearGeometry, int, long);

} // namespace isostat
